#include "solver/pipeline/warnings.h"

#include "meshing/core/plane_frame.h"
#include "meshing/repair/repair_sentence.h"
#include "solver/pipeline/first_few.h"
#include "solver/pipeline/outward_lamps.h"
#include "solver/pipeline/weak_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

/// Of the emitted power; beyond it nearly all is lost.
constexpr double nearly_all = 0.99;
/// Of the emitted power; where so much reaches surfaces, what leaves is what they reflect, and they
/// look the right way.
constexpr double clearly_arriving = 0.1;
/// Relative to a face's size or area: what moved by less counts as rounding.
constexpr double noticeable = 1e-3;

/// In the order of CurveKind, as --events has them.
constexpr std::array<const char*, curve_kinds> kind_names = {"contact", "face", "ev", "eee",
                                                             "horizon"};

const char* const way_out =
    "surfaces take part on the side where their corners run counter-clockwise; if they look the "
    "wrong way, --flip turns all of them and --orient those of closed shells";

/// Whether what was put right may have changed the light.
bool matters(const Scene& scene, const Repair& repair) {
  const auto material = [&](int face) -> const Material& {
    return scene.materials[at(scene.faces[at(face)].material)];
  };
  const auto area_of = [&](int face) { return area_vector(face_corners(scene, face)).norm(); };
  switch (repair.kind) {
    case Repair::Kind::coplanar_merged:
      return false;
    case Repair::Kind::crossed_split:
      return true;
    case Repair::Kind::degenerate_dropped: {
      const int face = repair.faces.front();
      const LocalScale scale = scale_of(face_corners(scene, face));
      return (material(face).exitance > 0).any() ||
             area_of(face) > noticeable * scale.size * scale.size;
    }
    case Repair::Kind::duplicate_dropped:
      return scene.faces[at(repair.faces.front())].material !=
             scene.faces[at(repair.faces.back())].material;
    case Repair::Kind::non_planar_triangulated:
      return repair.size > noticeable * scale_of(face_corners(scene, repair.faces.front())).size;
    case Repair::Kind::overlap_removed: {
      // A lamp set into a ceiling, or a rug on a floor, is what its maker wanted.
      const auto [keeper, loser] = std::pair(repair.faces.front(), repair.faces.back());
      return (material(loser).exitance > 0).any() ||
             (repair.size > noticeable * area_of(loser) &&
              repair.size < (1 - noticeable) * std::min(area_of(keeper), area_of(loser)));
    }
    case Repair::Kind::gap_shut:  // hardly any light gets in from elsewhere
      return std::any_of(repair.faces.begin(), repair.faces.end(),
                         [&](int face) { return (material(face).exitance > 0).any(); });
    case Repair::Kind::narrow_gap:  // a lamp that lights its gap is meant to
      return std::count_if(repair.faces.begin(), repair.faces.end(),
                           [&](int face) { return (material(face).exitance > 0).any(); }) != 1;
  }
  return false;
}

/// The first, and how many more there are.
std::string sentence(const std::vector<const Repair*>& found, const SoundScene& sound) {
  std::string text = sentence(*found.front(), sound);
  if (found.size() > 1)
    text += fmt::format("; and {} more like it (--verbose lists them)", found.size() - 1);
  return text;
}

bool is_unlit(const LightOutcome& outcome) { return (outcome.solution.irradiance == 0).all(); }

/// Groups without any light on them, those that are nothing but lamps left out. None where light is
/// too weak to be found.
std::vector<std::string> dark_groups(const LightOutcome& outcome) {
  const SoundScene& scene = outcome.scene;
  if (!weak_lights(scene, outcome.elements, outcome.solution).empty()) return {};
  std::vector<char> is_lit(scene.groups.size()), receives(scene.groups.size());
  for (int e = 0; e < outcome.elements.count(); ++e) {
    const std::size_t group = at(outcome.elements.group[at(e)]);
    const Material& material = scene.materials[at(outcome.elements.material[at(e)])];
    if ((material.exitance == 0).all()) receives[group] = 1;
    if ((outcome.solution.irradiance.row(e) > 0).any()) is_lit[group] = 1;
  }
  std::vector<std::string> names;
  for (std::size_t g = 0; g < is_lit.size(); ++g)
    if (receives[g] && !is_lit[g]) names.push_back(scene.groups[g]);
  return names;
}

/// Shares of what is emitted.
struct EmittedShares {
  double escaped = 0, absorbed = 0;
};

EmittedShares shares_of(const RadiosityReport& report) {
  double emitted = 0;
  EmittedShares shares;
  for (const ChannelReport& channel : report.channel) {
    emitted += channel.emitted_power;
    shares.escaped += channel.escaped_power;
    shares.absorbed += channel.absorbed_power;
  }
  if (!(emitted > 0)) return {};
  return {shares.escaped / emitted, shares.absorbed / emitted};
}

/// All but a small share, in words that do not say 100 % of what is less.
std::string nearly_all_but(double share) {
  constexpr double readable = 1e-6;
  if (!(share > 0)) return "all of the light";
  if (share < readable) return fmt::format("all but {:.2g} of the light", share);
  const int digits = std::max(2, static_cast<int>(std::ceil(-std::log10(100 * share))));
  return fmt::format("{:.{}f} % of the light", 100 * (1 - share), digits);
}

/// What arrives at surfaces of what is emitted; light that is reflected arrives more than once.
double arriving_share(const LightOutcome& outcome) {
  double emitted = 0, arriving = 0;
  for (const ChannelReport& channel : outcome.radiosity.channel) emitted += channel.emitted_power;
  for (int e = 0; e < outcome.elements.count(); ++e)
    arriving += outcome.elements.area[at(e)] * outcome.solution.irradiance.row(e).sum();
  return emitted > 0 ? arriving / emitted : 0;
}

/// Of light that is neither absorbed nor, in good part, lost by factors that are off. Light of a
/// number of bounces is not all absorbed where nothing gets out, either: what arrives tells then.
/// Advice only where it may help: what is reflected before it leaves did meet the right side.
std::vector<Warning> escape_warnings(const LightOutcome& outcome) {
  constexpr double mostly = 0.5;
  const EmittedShares shares = shares_of(outcome.radiosity);
  const bool arrives = arriving_share(outcome) >= clearly_arriving;
  if (!(shares.escaped > mostly && shares.absorbed < 1 - nearly_all)) return {};
  if (arrives && outcome.bounces >= 0) return {};
  const std::string text = fmt::format("{} leaves the scene or is swallowed by backs of surfaces",
                                       nearly_all_but(shares.absorbed));
  return {{Warning::Kind::light_escapes, arrives ? text : fmt::format("{}; {}", text, way_out)}};
}

/// What makes form factors better.
const char* more_of(FactorsBy by) {
  switch (by) {
    case FactorsBy::rays:
      return "more --rays or --elements";
    case FactorsBy::hemicube:
      return "more pixels (--hemicube) or --elements";
    case FactorsBy::exact:
      break;
  }
  return "more --elements";
}

}  // namespace

const char* name_of(Warning::Kind kind) {
  switch (kind) {
    case Warning::Kind::nothing_lit:
      return "nothing_lit";
    case Warning::Kind::light_escapes:
      return "light_escapes";
    case Warning::Kind::dark_groups:
      return "dark_groups";
    case Warning::Kind::outward_lamps:
      return "outward_lamps";
    case Warning::Kind::faces_changed:
      return "faces_changed";
    case Warning::Kind::narrow_gaps:
      return "narrow_gaps";
    case Warning::Kind::curves_left_out:
      return "curves_left_out";
    case Warning::Kind::contacts_left_out:
      return "contacts_left_out";
    case Warning::Kind::tolerance_raised:
      return "tolerance_raised";
    case Warning::Kind::elements_exceeded:
      return "elements_exceeded";
    case Warning::Kind::unknowns_exceeded:
      return "unknowns_exceeded";
    case Warning::Kind::power_gained:
      return "power_gained";
    case Warning::Kind::exchange_estimated:
      return "exchange_estimated";
    case Warning::Kind::backs_exchange:
      return "backs_exchange";
    case Warning::Kind::lost_by_factors:
      return "lost_by_factors";
    case Warning::Kind::lamps_uneven:
      return "lamps_uneven";
    case Warning::Kind::in_files:
      return "in_files";
    case Warning::Kind::guessed:
      return "guessed";
  }
  return "";
}

void add(const std::vector<Warning>& more, std::vector<Warning>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

std::vector<Warning> repair_warnings(const Scene& scene, const SoundScene& sound) {
  std::vector<const Repair*> changes, gaps;
  for (const Repair& repair : sound.repairs)
    if (matters(scene, repair))
      (repair.kind == Repair::Kind::narrow_gap ? gaps : changes).push_back(&repair);
  std::vector<Warning> warnings;
  if (!changes.empty())
    warnings.push_back(
        {Warning::Kind::faces_changed,
         "making the scene sound may have changed its light: " + sentence(changes, sound)});
  if (!gaps.empty()) warnings.push_back({Warning::Kind::narrow_gaps, sentence(gaps, sound)});
  return warnings;
}

Warning contacts_warning(std::optional<int> max_elements) {
  return {Warning::Kind::contacts_left_out,
          fmt::format("elements do not follow the lines along which surfaces touch and cut through "
                      "each other, for that takes {}: light gets smeared across "
                      "there, and closed spaces may count as open{}",
                      max_elements ? fmt::format("more than {} of them", *max_elements)
                                   : "too many of them",
                      max_elements ? "; --max-elements allows more" : "")};
}

std::vector<Warning> search_warnings(const DiscontinuityReport& report, double tolerance) {
  std::vector<std::string> kinds;
  double work = 0;
  for (std::size_t k = 0; k < report.left_out.size(); ++k) {
    if (!(report.left_out[k] > 0)) continue;
    kinds.push_back(kind_names[k]);
    work += report.left_out[k];
  }
  if (kinds.empty()) return {};
  return {
      {Warning::Kind::curves_left_out,
       fmt::format("curves of the kind{} {} are left out, in part or all: to find them among {} "
                   "edges would take about {:.2g} times the work that a tolerance of {:.2g} is "
                   "worth; --force discontinuities (solve) or --tolerance 0 (mesh) finds all, "
                   "--events names those to look for",
                   kinds.size() == 1 ? "" : "s", fmt::join(kinds, ", "), report.silhouette_edges,
                   (report.work + work) / report.most_work, tolerance)}};
}

std::vector<Warning> mesh_warnings(const MeshOutcome& outcome) {
  std::vector<Warning> warnings;
  if (outcome.asked_elements > 0 && outcome.plain_elements > outcome.asked_elements) {
    std::size_t contacts = 0;
    for (const Surface& surface : outcome.scene.surfaces) contacts += surface.contacts.size();
    warnings.push_back(
        {Warning::Kind::elements_exceeded,
         fmt::format("the {} surfaces and {} contact lines alone take {} elements, more than the "
                     "{} asked for with --elements{}",
                     outcome.scene.surfaces.size(), contacts, outcome.plain_elements,
                     outcome.asked_elements,
                     outcome.is_searched ? "" : ", so that no curves are looked for")});
  }
  if (outcome.tolerance > outcome.asked_tolerance)
    warnings.push_back(
        {Warning::Kind::tolerance_raised,
         fmt::format("the mesh {}, not all down to the share of {:.2g} of the mean irradiance "
                     "asked for with --tolerance: that takes more --elements",
                     outcome.kept == 0
                         ? "follows no curves"
                         : fmt::format("follows only curves above {:.2g}", outcome.tolerance),
                     outcome.asked_tolerance)});
  return warnings;
}

std::vector<Warning> unknowns_warnings(std::size_t unknowns, int max_unknowns, int rounds) {
  if (unknowns <= at(max_unknowns)) return {};
  return {
      {Warning::Kind::unknowns_exceeded,
       fmt::format("direct light takes {} unknowns{}, more than the {} that --max-unknowns "
                   "allows",
                   unknowns, rounds > 1 ? "" : " before any element is divided", max_unknowns)}};
}

std::vector<Warning> power_warnings(const RadiosityReport& report, double tolerance) {
  double gained = 0;
  for (int c = 0; c < report.channels; ++c) {
    const ChannelReport& channel = report.channel[at(c)];
    if (channel.emitted_power > 0)
      gained = std::max(gained, channel.absorbed_power / channel.emitted_power - 1);
  }
  if (gained <= tolerance) return {};
  return {
      {Warning::Kind::power_gained,
       fmt::format("surfaces absorb {:.2g} % more than lamps emit: the error asked for is of all "
                   "light, which little that is very bright makes up, and dark places may be off "
                   "by far more of their own; --goal asks for the mean of a group",
                   100 * gained)}};
}

std::vector<Warning> exchange_warnings(const ExchangeReport& report) {
  if (!(report.estimated_share > 0)) return {};
  return {{Warning::Kind::exchange_estimated,
           fmt::format("the form factors were interrupted: a few rays from each element stand for "
                       "{:.2g} % of the exchange of light, and the estimated error says what that "
                       "does",
                       100 * report.estimated_share)}};
}

std::vector<Warning> light_warnings(const LightOutcome& outcome) {
  std::vector<Warning> warnings;
  const std::vector<std::string> dark = dark_groups(outcome);
  if (is_unlit(outcome))
    warnings.push_back(
        {Warning::Kind::nothing_lit, fmt::format("no light reaches any surface; {}", way_out)});
  else
    add(escape_warnings(outcome), warnings);
  if (!is_unlit(outcome) && !dark.empty())
    warnings.push_back({Warning::Kind::dark_groups,
                        fmt::format("no light reaches the group{} {}; {}",
                                    dark.size() == 1 ? "" : "s", first_few(dark), way_out)});
  const std::vector<std::string> outward = outward_lamps(outcome.scene);
  if (!is_unlit(outcome) && !outward.empty())
    warnings.push_back(
        {Warning::Kind::outward_lamps,
         fmt::format(
             "no surface lies before what emits in the group{} {}, and its light is lost; {}",
             outward.size() == 1 ? "" : "s", first_few(outward), way_out)});
  if (outcome.exchange.unfinished > 0)
    warnings.push_back(
        {Warning::Kind::lost_by_factors,
         fmt::format("in {} closed space{} form factors of an element are off by {:.2g} in all, so "
                     "light gets lost there; {} help",
                     outcome.exchange.unfinished, outcome.exchange.unfinished == 1 ? "" : "s",
                     outcome.exchange.closure_error_max, more_of(outcome.exchange.by))});
  return warnings;
}

}  // namespace halfshade
