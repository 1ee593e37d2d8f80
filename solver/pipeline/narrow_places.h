#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "solver/adapt/watched.h"

#include <span>
#include <vector>

namespace halfshade {

/// Where narrow shadows fall that samples might overlook, and narrow light between wide ones, as of
/// bars, the arms of a comb, slits and pinholes: seen from the middle of each source and from its
/// corners, the edges of `blocking` surfaces are lines on what is behind, and between lines close
/// to each other is something narrow. Areas are those of its width and of the penumbra along what
/// the place stands for. Where there are very many sources, surfaces and edges only the middles of
/// sources are followed, and only to the largest receivers; of very many places those that are
/// largest are kept, and if stopped some are missing. Cost: sources times receivers times edges.
std::vector<WatchedPlace> narrow_places(const SoundScene& scene, std::span<const int> sources,
                                        std::span<const int> blocking,
                                        const Progress& progress = {});

}  // namespace halfshade
