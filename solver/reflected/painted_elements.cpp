#include "solver/reflected/painted_elements.h"

#include "meshing/core/parallel.h"

#include <algorithm>
#include <utility>

namespace halfshade {

PaintedElements::PaintedElements(std::vector<int> paint, std::vector<Paint> paints)
    : paint_(std::move(paint)), paints_(std::move(paints)) {
  if (std::all_of(paint_.begin(), paint_.end(), [](int p) { return p < 0; })) paint_.clear();
}

void PaintedElements::update(const ReflectedMesh& mesh, const std::vector<Rgb>& rho) {
  if (paint_.empty()) return;
  of_triangle_.resize(at(mesh.forest.count()));
  parallel_for(at(mesh.count()), [&](std::size_t e) {
    const int t = mesh.triangle[e], root = mesh.forest.root(t), order = mesh.order[at(t)];
    if (!is_painted(root)) return;
    auto& kept = of_triangle_[at(t)];
    if (kept && (*kept)[0].rows() == basis_size(order)) return;
    kept = std::make_shared<const PaintedProduct>(painted_product(
        paints_[at(paint_[at(root)])], rho[at(root)], mesh.forest.corners(t), order));
  });
}

}  // namespace halfshade
