#pragma once

#include "meshing/core/progress.h"
#include "solver/reference/sample_sequence.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace halfshade {

/// A camera: pixel coordinates begin in the upper left corner, rays through a pixel go along corner
/// + x·right + y·down, which is 1 long along the camera's axis.
struct CameraRays {
  Vec3 origin, corner, right, down;
  int width = 0, height = 0;  ///< pixels, ≥ 1
  double lens = 0;            ///< radius, ≥ 0: what is nearer or farther than `focus` is blurred
  double focus = 1;           ///< distance along the axis, > 0
  Vec3 move = Vec3::Zero();   ///< way of the origin while the shutter is open, at an even speed

  Vec3 ray(const Vec2& pixel) const { return corner + pixel.x() * right + pixel.y() * down; }
};

struct PixelOptions {
  int samples = 64;  ///< rays through each pixel, ≥ 1; rounded up to `batches` times a power of two
  int batches = 8;         ///< ≥ 2, independent of each other: they tell the standard error
  std::uint64_t seed = 0;  ///< others give independent pictures
};

/// What a ray finds.
struct SeenLight {
  Rgb radiance = Rgb::Zero();  ///< W/(m² sr)
  bool emits = false;          ///< it meets an emitter first
};

/// Pixels, top row first.
struct TracedPicture {
  int width = 0, height = 0;
  std::vector<Rgb> radiance;        ///< mean over each pixel, W/(m² sr)
  std::vector<Rgb> standard_error;  ///< of it
  std::vector<std::uint8_t> emits;  ///< 1 where any ray met an emitter first
  int samples = 0;                  ///< of each pixel
  bool complete = true;             ///< false if stopped: pixels that were not reached are black

  /// Root mean square of the standard error (mean of the channels), relative to that of the
  /// radiance, over pixels without emitters, for those are many times as bright; over all where
  /// there are no others; 0 in the dark.
  double relative_error() const;
};

/// Gets a ray of unit direction, and numbers of its own.
using Look = std::function<SeenLight(const Vec3& origin, const Vec3& direction,
                                     const SampleNumbers& numbers)>;

/// Looks through every pixel at random places, spread evenly: edges are smooth; from random places
/// of the lens, and at random times of its move (Cook, Porter and Carpenter 1984). On all threads;
/// what a pixel gets does not depend on their number. Throws Error(contract) for options out of
/// range.
TracedPicture trace_pixels(const CameraRays& camera, const PixelOptions& options, const Look& look,
                           const Progress& progress = {});

}  // namespace halfshade
