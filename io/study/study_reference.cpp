#include "io/study/study_reference.h"

#include "io/files/atomic_file.h"
#include "io/read/read_text.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/rays/occluders.h"
#include "solver/reference/reference_light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

double random_number(std::size_t point, std::uint64_t use) {
  return unit_share(mix_bits(mix_bits(point) + use));
}

std::vector<SurfacePoint> spread_points(const SoundScene& scene, int count) {
  const TriangleSoup soup = surface_triangles(scene);
  const auto corner = [&](std::size_t t, std::size_t k) -> const Vec3& {
    return soup.points[at(soup.triangles[t][k])];
  };
  std::vector<double> sums;
  double area = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    sums.push_back(area += (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm());
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < at(count); ++i) {
    const double at_area = (static_cast<double>(i) + random_number(i, 0)) / count * area;
    const auto found = std::upper_bound(sums.begin(), sums.end() - 1, at_area);
    const auto t = static_cast<std::size_t>(found - sums.begin());
    const double across = std::sqrt(random_number(i, 1)), along = random_number(i, 2);
    const PlaneFrame& frame = scene.surfaces[at(soup.owner[t])].frame;
    points.push_back(
        {(1 - across) * corner(t, 0) + across * ((1 - along) * corner(t, 1) + along * corner(t, 2)),
         frame.normal});
  }
  return points;
}

double mean_square(const std::vector<Rgb>& values) {
  double sum = 0;
  for (const Rgb& v : values) sum += v.square().sum();
  return sum / static_cast<double>(values.size());
}

/// Of `found` against `right`, which has the mean square `noise` of its own.
StudyError error_of(const std::vector<Rgb>& found, const std::vector<Rgb>& right, double noise,
                    double scale, double resolution) {
  std::vector<Rgb> off;
  double most = 0;
  for (std::size_t k = 0; k < right.size(); ++k) {
    off.push_back(found[k] - right[k]);
    most = std::max(most, off.back().abs().maxCoeff());
  }
  const double square = std::max(0., mean_square(off) - noise);
  return {std::max(std::sqrt(square) / scale, resolution), most / scale};
}

std::vector<Rgb> sums(const std::vector<Rgb>& a, const std::vector<Rgb>& b, double sign) {
  std::vector<Rgb> result;
  for (std::size_t k = 0; k < a.size(); ++k) result.emplace_back(a[k] + sign * b[k]);
  return result;
}

/// The three columns of a table that begin with `name`.
std::vector<Rgb> colours_in(const TextTable& table, const std::string& name, const fs::path& path) {
  const auto found = std::find(table.header.begin(), table.header.end(), name);
  if (table.header.end() - found < 3)
    reading::fail(path, 0, fmt::format("the column '{}' is missing", name));
  const auto first = static_cast<std::size_t>(found - table.header.begin());
  std::vector<Rgb> values;
  for (const auto& row : table.rows) {
    Rgb& value = values.emplace_back();
    for (std::size_t c = 0; c < 3; ++c)
      value[static_cast<Eigen::Index>(c)] = number_in(row[first + c], path);
  }
  return values;
}

}  // namespace

double StudyReference::scale() const {
  return std::sqrt(
      std::max(mean_square(sums(direct, reflected, 1)), std::numeric_limits<double>::min()));
}

double StudyReference::noise() const { return std::sqrt(mean_square(reflected_error)) / scale(); }

double StudyReference::resolution() const {
  // Two standard deviations of the mean square of normal noise; channels of a point go together.
  double fourth = 0;
  for (const Rgb& error : reflected_error) fourth += 2 * std::pow(error.square().sum(), 2);
  const auto n = static_cast<double>(reflected_error.size());
  return std::sqrt(2 * std::sqrt(fourth) / n) / scale();
}

std::optional<StudyReference> find_reference(const PreparedScene& prepared,
                                             const StudyReferenceOptions& options,
                                             const Progress& progress) {
  StudyReference result;
  result.points = point_table(spread_points(prepared.scene(), options.points));
  const std::vector<SurfacePoint>& points = result.points.points;
  for (const DirectLight& light : prepared.direct_light().irradiance(points, progress))
    result.direct.push_back(light.irradiance);
  result.reflected.assign(points.size(), Rgb::Zero());
  result.reflected_error = result.reflected;
  if (options.direct_only) return progress.stopped() ? std::nullopt : std::optional(result);
  std::vector<ReferencePoint> places;
  for (const SurfacePoint& point : points) places.push_back({point.position, point.normal});
  ReferenceOptions walks;
  walks.samples = options.samples;
  const ReferenceLight light = reference_light(prepared.scene(), places, walks, progress);
  if (!light.complete) return std::nullopt;
  for (std::size_t k = 0; k < points.size(); ++k) {
    result.reflected[k] = light.values[k].reflected;
    result.reflected_error[k] = light.standard_errors[k].reflected;
  }
  return result;
}

void write_reference(const StudyReference& reference, const std::string& key,
                     const fs::path& path) {
  std::string bytes =
      fmt::format("# {}\n{},D_r,D_g,D_b,G_r,G_g,G_b,G_r_error,G_g_error,G_b_error\n", key,
                  reference.points.header);
  for (std::size_t k = 0; k < reference.direct.size(); ++k) {
    bytes += reference.points.rows[k];
    for (const auto* values : {&reference.direct, &reference.reflected, &reference.reflected_error})
      for (const double v : (*values)[k]) bytes += fmt::format(",{}", v);
    bytes += '\n';
  }
  write_atomically(path, bytes);
}

void write_places(const StudyReference& reference, const fs::path& path) {
  write_atomically(path, fmt::format("{}\n{}\n", reference.points.header,
                                     fmt::join(reference.points.rows, "\n")));
}

StudyReference read_reference(const std::string& key, const fs::path& path) {
  const TextTable table = read_table(path);
  require_key(table, key, path);
  StudyReference reference;
  reference.points = point_table(read_points(path).points);
  reference.direct = colours_in(table, "D_r", path);
  reference.reflected = colours_in(table, "G_r", path);
  reference.reflected_error = colours_in(table, "G_r_error", path);
  return reference;
}

StudyValues read_values(const fs::path& path) {
  const TextTable table = read_table(path);
  return {colours_in(table, "H_r", path), colours_in(table, "D_r", path)};
}

void fill_errors(const StudyReference& reference, const StudyValues& values, StudyRow& row) {
  const double scale = reference.scale(), noise = mean_square(reference.reflected_error);
  const double resolution = reference.resolution();
  row.direct = error_of(values.direct, reference.direct, 0, scale, 0);
  row.reflected = error_of(sums(values.irradiance, values.direct, -1), reference.reflected, noise,
                           scale, resolution);
  row.total = error_of(values.irradiance, sums(reference.direct, reference.reflected, 1), noise,
                       scale, resolution);
}

}  // namespace halfshade
