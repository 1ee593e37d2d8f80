#pragma once

#include "meshing/triangulation/curve_mesh.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

/// Lines that are hard on a mesher, about the unit square.
namespace halfshade::test {

class LineFamily {
 public:
  LineFamily(std::string name, unsigned seed) : name_(std::move(name)), random_(seed) {}

  std::vector<CurvePolyline> make(int n) {
    lines_.clear();
    for (int i = 0; i < n; ++i) add(i);
    return lines_;
  }

 private:
  double uniform(double low = 0, double high = 1) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec2 place() {
    const double x = uniform();
    return {x, uniform()};
  }
  static Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
  void line(const Vec2& a, const Vec2& b) {
    lines_.push_back({{a, b}, static_cast<int>(lines_.size())});
  }

  void add(int i) {
    if (name_ == "Random") line(place(), place());
    if (name_ == "Concurrent") {  // to within a tenth of the snap distance
      const Vec2 through = Vec2(0.4, 0.6) + 1e-8 * place(), d = unit(uniform(0, 2 * M_PI));
      line(through - uniform() * d, through + uniform() * d);
    }
    if (name_ == "NearParallel") {
      const double y = i % 3 == 0 ? uniform(0.3, 0.7) : 0.5 + 1e-7 * uniform() * (i % 7);
      line({-0.1, y}, {1.1, y + uniform(-5e-7, 5e-7)});
    }
    if (name_ == "AxisAligned") {
      const double c = std::floor(uniform(0, 64)) / 64 + (i % 4 == 0 ? 1e-8 * uniform() : 0);
      const double a = uniform(), b = uniform();
      i % 2 == 0 ? line({a, c}, {b, c}) : line({c, a}, {c, b});
    }
    if (name_ == "ConicTangent") add_arc_and_tangent();
    if (name_ == "Fan") line({0.4, 0}, Vec2(0.4, 0) + 2 * unit(0.1 * (i + 1)));
    if (name_ == "Offset") {  // 1e-6 apart
      const Vec2 d = unit(0.3), o = Vec2(0.5, 0.5) + 1e-6 * i * Vec2(-d.y(), d.x());
      line(o - 2 * d, o + 2 * d);
    }
    if (name_ == "Coincident") {  // many times the same five lines, also backwards and in parts
      const Vec2 d = unit(0.7 * (i % 5)), o(0.5, 0.5);
      line(o - uniform(-0.5, 1) * d, o + uniform(-0.4, 1) * d);
      if (i % 3 == 0) line(o, o);
    }
    if (name_ == "AlongTheBorder") {
      const double y = i % 2 + 1e-7 * uniform(-0.5, 0.5) * (i % 9);
      line({uniform(), y}, {uniform(), y + uniform(-2e-7, 2e-7)});
    }
  }

  void add_arc_and_tangent() {
    const Vec2 centre = place(), radii(uniform(0.1, 0.4), uniform(0.05, 0.2));
    const double start = uniform(0, 2 * M_PI);
    CurvePolyline arc;
    arc.id = static_cast<int>(lines_.size());
    for (int k = 0; k <= 16; ++k)
      arc.points.push_back(centre + radii.cwiseProduct(unit(start + 0.1 * k)));
    lines_.push_back(arc);
    const Vec2 along = (arc.points[9] - arc.points[7]).normalized();
    line(arc.points[8] - along, arc.points[8] + along);
  }

  std::string name_;
  std::mt19937 random_;
  std::vector<CurvePolyline> lines_;
};

}  // namespace halfshade::test
