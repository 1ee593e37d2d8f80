#include "io/study/study_page.h"

#include <fmt/format.h>

#include <fstream>
#include <sys/utsname.h>
#include <thread>
#include <unistd.h>

namespace halfshade {
namespace {

std::string processor() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown processor";
}

}  // namespace

std::string machine_line() {
  utsname system{};
  uname(&system);
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e9;
  return fmt::format("{}, {} threads, {:.0f} GB, {} {} {}", processor(),
                     std::thread::hardware_concurrency(), memory, system.sysname, system.release,
                     system.machine);
}

}  // namespace halfshade
