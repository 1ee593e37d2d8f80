#include "meshing/events/critical_event.h"

#include "meshing/core/error.h"

namespace halfshade {

Feature feature_of(EdgeId edge) {
  switch (edge.kind) {
    case EdgeId::Kind::emitter_edge:
      return {Feature::Kind::emitter_edge, edge.id};
    case EdgeId::Kind::edge:
      return {Feature::Kind::edge, edge.id};
    case EdgeId::Kind::cut:
    case EdgeId::Kind::horizon:
      break;
  }
  throw Error(ErrorCode::contract, "feature_of",
              "the horizon and the cuts of triangles are no features");
}

}  // namespace halfshade
