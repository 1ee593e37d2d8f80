#include "meshing/core/planar.h"
#include "meshing/discontinuity/margins.h"
#include "meshing/discontinuity/stacked_curves.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace halfshade {
namespace {

/// The triangle an arc lies in and what is within some length of it.
class ControlTriangle {
 public:
  ControlTriangle(const ConicArc& arc, double length)
      : corners_{arc.from, arc.control, arc.to},
        side_(cross_2d(arc.control - arc.from, arc.to - arc.from) < 0 ? -1 : 1),
        length_(length) {
    for (const Vec2& p : corners_) box_.include(flat_bounds(p, p));
    box_ = box_.grown(length);
  }

  /// False only if it and a box do not meet.
  bool meets(const Bounds& box) const {
    if (!box.meets(box_)) return false;
    const Vec2 centre = box.centre().head<2>(), half = box.half_size().head<2>();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 d = corners_[(i + 1) % 3] - corners_[i];
      const double reach =
          length_ * d.norm() + std::abs(d.y()) * half.x() + std::abs(d.x()) * half.y();
      if (side_ * cross_2d(d, centre - corners_[i]) < -reach) return false;
    }
    return true;
  }

 private:
  std::array<Vec2, 3> corners_;
  double side_, length_;
  Bounds box_;
};

/// Cuts the arcs of one receiver and emitter at each other's ends where they run together.
class ArcCutter {
 public:
  ArcCutter(std::span<const DiscontinuityCurve> curves, std::span<const int> which,
            double tolerance)
      : curves_(curves),
        which_(which),
        tolerance_(tolerance),
        ends_(make_flat_tree(end_points(), 1)) {}

  /// For each arc the parameters between its pieces, with 0 and 1.
  std::vector<std::vector<double>> cuts() const {
    std::vector<std::vector<double>> all(which_.size(), {0, 1});
    for (std::size_t i = 0; i < which_.size(); ++i) {
      visit_ends_near(i, [&](std::size_t j, double end) {
        const std::optional<double> s = parameter_of(i, point_at(arc(j), end));
        if (i != j && s && run_together_from(j, end, i)) all[i].push_back(*s);
      });
      clean(arc(i), all[i]);
    }
    return all;
  }

 private:
  const ConicArc& arc(std::size_t i) const { return curves_[at(which_[i])].arc; }

  /// Of arc k: numbers 2 k and 2 k + 1.
  std::vector<Bounds> end_points() const {
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < which_.size(); ++i)
      for (const Vec2& p : {arc(i).from, arc(i).to}) boxes.push_back(flat_bounds(p, p));
    return boxes;
  }

  /// Calls visit(j, 0 or 1) for ends of arcs near arc i, for some twice.
  template <class Visit>
  void visit_ends_near(std::size_t i, const Visit& visit) const {
    constexpr double thin = 1e-3;  // some ten pieces, whose triangles have next to no area
    const double size = (arc(i).control - arc(i).from).norm() + (arc(i).to - arc(i).control).norm();
    const std::vector<double> pieces = flatten(arc(i), std::max(thin * size, tolerance_));
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
      const ControlTriangle triangle(part(arc(i), pieces[k], pieces[k + 1]), tolerance_);
      visit_reached(
          ends_, [&](const Bounds& box) { return triangle.meets(box); },
          [&](int end) { visit(at(end / 2), end % 2); });
    }
  }

  /// Of a point on an arc.
  std::optional<double> parameter_of(std::size_t i, const Vec2& p) const {
    const double s = nearest_parameter(arc(i), p);
    if ((point_at(arc(i), s) - p).norm() > tolerance_) return std::nullopt;
    return s;
  }

  /// Whether arc i runs along j, from its end, which is on j, until one of them ends.
  bool run_together_from(std::size_t i, double end, std::size_t j) const {
    const Vec2 start = point_at(arc(i), end);
    double until = end;  // the nearest place, beyond the tolerance, where one of them ends
    const auto consider = [&](const Vec2& p) {
      if ((p - start).norm() <= margins::joined_ends * tolerance_) return;
      const std::optional<double> s = parameter_of(i, p);
      if (s && (until == end || std::abs(*s - end) < std::abs(until - end))) until = *s;
    };
    consider(arc(j).from);
    consider(arc(j).to);
    const double far = 1 - end;
    if (until == end && parameter_of(j, point_at(arc(i), far))) until = far;
    if (until == end) return false;
    for (const double share : {0.25, 0.5, 0.75})
      if (!parameter_of(j, point_at(arc(i), end + share * (until - end)))) return false;
    return true;
  }

  /// Sorts cuts and drops those close to others; the ends stay.
  void clean(const ConicArc& arc, std::vector<double>& cuts) const {
    std::sort(cuts.begin(), cuts.end());
    std::vector<double> kept = {0};
    for (const double s : cuts) {
      const Vec2 p = point_at(arc, s);
      if ((p - point_at(arc, kept.back())).norm() > margins::joined_ends * tolerance_ &&
          (p - arc.to).norm() > margins::joined_ends * tolerance_)
        kept.push_back(s);
    }
    kept.push_back(1);
    cuts = std::move(kept);
  }

  std::span<const DiscontinuityCurve> curves_;
  std::span<const int> which_;
  double tolerance_;
  FlatTree ends_;
};

/// A piece of an arc between two cuts.
struct ArcPiece {
  int curve = 0;
  double s0 = 0, s1 = 1;
  ConicArc arc;
  Vec2 middle = Vec2::Zero();        ///< farthest from the chord; the same for equal pieces
  std::vector<StackedCurve> equals;  ///< itself and equal ones after it; empty if it is such a one
};

/// 1 if two pieces are equal, −1 if they are and run in opposite directions, else 0.
int equality(const ArcPiece& a, const ArcPiece& b, double length) {
  const auto near = [&](const Vec2& p, const Vec2& q) { return (p - q).norm() <= length; };
  if (a.curve == b.curve || !near(a.middle, b.middle)) return 0;
  if (near(a.arc.from, b.arc.from) && near(a.arc.to, b.arc.to)) return 1;
  if (near(a.arc.from, b.arc.to) && near(a.arc.to, b.arc.from)) return -1;
  return 0;
}

/// Attaches each piece to the first one that equals it.
void gather_equals(std::vector<ArcPiece>& pieces, double length) {
  std::vector<std::size_t> sorted(pieces.size());
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t i, std::size_t j) {
    return pieces[i].middle.x() < pieces[j].middle.x();
  });
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double x = pieces[i].middle.x();
    auto candidate =
        std::lower_bound(sorted.begin(), sorted.end(), x - length,
                         [&](std::size_t j, double value) { return pieces[j].middle.x() < value; });
    std::size_t first = i;
    int sign = 1;
    for (; candidate != sorted.end() && pieces[*candidate].middle.x() <= x + length; ++candidate) {
      if (*candidate >= first || pieces[*candidate].equals.empty()) continue;
      if (const int equal = equality(pieces[*candidate], pieces[i], length)) {
        first = *candidate;
        sign = equal;
      }
    }
    pieces[first].equals.push_back({pieces[i].curve, sign < 0});
  }
}

/// How many unions it takes to connect all curves that have pieces in common.
std::size_t count_unions(std::span<const ArcPiece> pieces, std::size_t curves) {
  std::vector<int> parent(curves);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[at(i)] != i) i = parent[at(i)];
    return i;
  };
  std::size_t unions = 0;
  for (const ArcPiece& piece : pieces)
    for (const StackedCurve& other : piece.equals) {
      const int a = root(piece.curve), b = root(other.curve);
      if (a == b) continue;
      parent[at(std::max(a, b))] = std::min(a, b);
      ++unions;
    }
  return unions;
}

/// Writes what is left of one curve; consecutive pieces that are alike as one.
void write(std::span<const DiscontinuityCurve> curves, std::span<const ArcPiece> pieces,
           std::vector<MergedCurve>& merged) {
  const int place = pieces.front().curve;
  const DiscontinuityCurve& whole = curves[at(place)];
  if (pieces.size() == 1 && pieces.front().equals.size() == 1) {
    merged.push_back({place, whole});
    return;
  }
  double begin = 0, end = -1;  // of the last piece written
  for (const ArcPiece& piece : pieces) {
    if (piece.equals.empty()) continue;
    DiscontinuityCurve curve = stack(curves, piece.equals, piece.arc);
    if (piece.s0 == end && alike(merged.back().curve, curve)) {
      merged.back().curve.arc =
          begin == 0 && piece.s1 == 1 ? whole.arc : part(whole.arc, begin, piece.s1);
    } else {
      merged.push_back({place, std::move(curve)});
      begin = piece.s0;
    }
    end = piece.s1;
  }
}

}  // namespace

std::size_t merge_conics(std::span<const DiscontinuityCurve> curves, std::span<const int> which,
                         double tolerance, std::vector<MergedCurve>& merged) {
  const std::vector<std::vector<double>> cuts = ArcCutter(curves, which, tolerance).cuts();
  std::vector<ArcPiece> pieces;
  for (std::size_t i = 0; i < which.size(); ++i) {
    const ConicArc& arc = curves[at(which[i])].arc;
    for (std::size_t k = 0; k + 1 < cuts[i].size(); ++k) {
      const bool all = cuts[i].size() == 2;
      const ConicArc piece = all ? arc : part(arc, cuts[i][k], cuts[i][k + 1]);
      pieces.push_back({which[i], cuts[i][k], cuts[i][k + 1], piece, point_at(piece, 0.5), {}});
    }
  }
  gather_equals(pieces, margins::joined_ends * tolerance);
  for (std::size_t begin = 0; begin < pieces.size();) {
    std::size_t end = begin;
    while (end < pieces.size() && pieces[end].curve == pieces[begin].curve) ++end;
    write(curves, {pieces.data() + begin, end - begin}, merged);
    begin = end;
  }
  return count_unions(pieces, curves.size());
}

}  // namespace halfshade
