#include "meshing/discontinuity/curve_fitting.h"

namespace halfshade {
namespace {

// How often a conic may be halved before it is made of arcs that turn little.
constexpr int most_halvings = 6;

/// Fits arcs to the curve of one swath on one plane.
class ConicFit {
 public:
  ConicFit(const Swath& swath, const PlaneFrame& plane, double flat, std::vector<ConicArc>& arcs)
      : swath_(swath), plane_(plane), flat_(flat), arcs_(arcs) {}

  void add(double t0, double t1, int halvings) {
    const double tm = 0.5 * (t0 + t1);
    const auto a = trace_at(swath_, plane_, t0), b = trace_at(swath_, plane_, tm),
               c = trace_at(swath_, plane_, t1);
    if (!a || !b || !c) return;
    const Vec2 from = plane_.to_plane(a->point), to = plane_.to_plane(c->point);
    if (const auto arc =
            conic_arc(from, direction(*a), plane_.to_plane(b->point), to, direction(*c), flat_)) {
      arcs_.push_back(*arc);
    } else if (halvings > 0) {
      add(t0, tm, halvings - 1);
      add(tm, t1, halvings - 1);
    } else {
      arcs_.push_back(straight_arc(from, to));
    }
  }

 private:
  Vec2 direction(const Trace& trace) const {
    return {plane_.e1.dot(trace.tangent), plane_.e2.dot(trace.tangent)};
  }

  const Swath& swath_;
  const PlaneFrame& plane_;
  double flat_;
  std::vector<ConicArc>& arcs_;
};

}  // namespace

std::vector<ConicArc> fit_arcs(const Swath& swath, double t0, double t1, const PlaneFrame& plane,
                               double flat) {
  if (swath.is_planar)
    return {straight_arc(plane.to_plane(trace_at(swath, plane, t0)->point),
                         plane.to_plane(trace_at(swath, plane, t1)->point))};
  std::vector<ConicArc> arcs;
  ConicFit(swath, plane, flat, arcs).add(t0, t1, most_halvings);
  return arcs;
}

}  // namespace halfshade
