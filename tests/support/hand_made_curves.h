#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "tests/support/sound_scenes.h"

namespace halfshade::test {

/// Three curves on the floor of S1 (receiver 2) that nothing in the scene makes: a D1 line
/// x = 1.2 + floor's centre, a quarter of a circle of radius 1 about the floor's centre (D2, three
/// edges), a contact line. Coordinates are those of the floor's frame.
inline Discontinuities hand_made_curves() {
  Discontinuities found;
  found.sources = {{0, 1}};
  DiscontinuityCurve line;
  line.receiver = 2;
  line.kind = CurveKind::ev;
  line.order = 1;
  line.arc = straight_arc({1.2, -0.5}, {1.2, 0.5});
  line.jump = {-0.1, -0.2, -0.3};
  line.sources = {
      {CurveKind::ev, {{{Feature::Kind::emitter_edge, 3}, {Feature::Kind::edge, 2}}}, 2},
      {CurveKind::ev, {{{Feature::Kind::vertex, 7}, {Feature::Kind::edge, 5}}}, 2}};
  DiscontinuityCurve circle;
  circle.receiver = 2;
  circle.kind = CurveKind::eee;
  circle.order = 2;
  circle.arc = {{1, 0}, {1, 1}, {0, 1}, std::sqrt(0.5), false};
  circle.jump = {1, 2, 5};
  circle.sources = {
      {CurveKind::eee,
       {{{Feature::Kind::emitter_edge, 0}, {Feature::Kind::edge, 8}, {Feature::Kind::edge, 9}}},
       3}};
  DiscontinuityCurve contact;
  contact.receiver = 2;
  contact.kind = CurveKind::contact;
  contact.order = 0;
  contact.arc = straight_arc({-1, -1}, {-0.25, -1});
  contact.jump = {0.5, 0.5, 0.5};
  contact.sources = {{CurveKind::contact, {{{Feature::Kind::face, 1}}}, 1}};
  found.curves = {line, circle, contact};
  return found;
}

}  // namespace halfshade::test
