#pragma once

#include "io/write_result.h"

#include <string>
#include <string_view>

namespace halfshade::detail {

/// The bytes of the files that write_result writes.
std::string vtu_bytes(const SolveResult& result, const Provenance& provenance);
std::string vtp_bytes(const SolveResult& result, const Provenance& provenance);
std::string ply_bytes(const SolveResult& result, const Provenance& provenance);

/// Ends an XML file with a comment that holds a checksum of what is before it: VTK's reader can
/// crash on damaged data, so files are only given to it if `is_sealed` says they are as written.
std::string seal(std::string xml);
bool is_sealed(std::string_view bytes);

/// [{"name", "position", "direction", "up", "vertical_fov"}, …], as in a scene's sidecar, and back.
/// The way back throws std::exception for anything else.
std::string cameras_to_json(const std::vector<Camera>& cameras);
std::vector<Camera> cameras_from_json(const std::string& text);

/// Throws Error(contract) unless every array of the result has as many entries as there are
/// elements and every corner is a point.
void require_consistent(const SolveResult& result, const char* caller);
void require_consistent(const ElementTable& elements, const char* caller);

/// The extension in small letters.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace halfshade::detail
