#include "meshing/core/parallel.h"
#include "solver/exchange/scaled_operator.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

namespace halfshade {
namespace {

/// A matrix like that of form factors: n rows, a good half of the entries non-zero.
ExchangeMatrix half_full_matrix(int n) {
  ExchangeMatrix matrix(n, n);
  matrix.reserve(Eigen::VectorXi::Constant(n, n / 2 + 1));
  for (int i = 0; i < n; ++i)
    for (int j = (i % 2); j < n; j += 2) matrix.insert(i, j) = 1. / (1 + i + j);
  matrix.makeCompressed();
  return matrix;
}

/// Bytes read per second by y = M x: 12 a non-zero.
void sparse_times_vector(benchmark::State& state) {
  const ExchangeMatrix matrix = half_full_matrix(static_cast<int>(state.range(0)));
  const Eigen::VectorXd x = Eigen::VectorXd::Ones(matrix.cols());
  for (auto _ : state) benchmark::DoNotOptimize(multiply(matrix, x).data());
  state.SetBytesProcessed(state.iterations() * matrix.nonZeros() * 12);
}
BENCHMARK(sparse_times_vector)->Arg(4000)->Arg(8000)->UseRealTime()->Unit(benchmark::kMillisecond);

/// The same by Eigen alone, on one thread.
void sparse_times_vector_eigen(benchmark::State& state) {
  const ExchangeMatrix matrix = half_full_matrix(static_cast<int>(state.range(0)));
  const Eigen::VectorXd x = Eigen::VectorXd::Ones(matrix.cols());
  Eigen::VectorXd y(matrix.rows());
  for (auto _ : state) {
    y.noalias() = matrix * x;
    benchmark::DoNotOptimize(y.data());
  }
  state.SetBytesProcessed(state.iterations() * matrix.nonZeros() * 12);
}
BENCHMARK(sparse_times_vector_eigen)->Arg(8000)->UseRealTime()->Unit(benchmark::kMillisecond);

/// What memory can deliver: the sum of as many bytes, on all threads.
void memory_read_bandwidth(benchmark::State& state) {
  constexpr std::size_t blocks = 256;
  const std::size_t count = 48'000'000;
  const std::vector<double> data(count, 1.);
  std::vector<double> sums(blocks);
  for (auto _ : state) {
    parallel_for(blocks, [&](std::size_t b) {
      const std::size_t begin = b * count / blocks, end = (b + 1) * count / blocks;
      sums[b] = Eigen::Map<const Eigen::ArrayXd>(data.data() + begin,
                                                 static_cast<Eigen::Index>(end - begin))
                    .sum();
    });
    benchmark::DoNotOptimize(sums.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(8 * count));
}
BENCHMARK(memory_read_bandwidth)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace halfshade
