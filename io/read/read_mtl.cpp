// Wavefront MTL: Kd is the reflectance, Ke the exitance in W/m², map_Kd and map_Ke are pictures
// that multiply them; emissivity, temperature (K) and net_flux are ours.

#include "io/read/heat_values.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace halfshade::reading {
namespace {

class MtlReader {
 public:
  MtlReader(const std::filesystem::path& file, SceneDraft& draft) : file_(file), draft_(draft) {}

  void read() {
    const std::string bytes = read_bytes(file_);
    LineReader lines(bytes, LineReader::Continuation::backslash);
    while (lines.next()) {
      line_ = lines.line();
      statement(lines.text());
    }
    finish_material();
  }

 private:
  void statement(std::string_view text) {
    split(text, words_);
    const std::string_view keyword = words_[0];
    const std::string small = lower(keyword);
    if (small == "newmtl") {
      finish_material();
      start_material(trimmed(text.substr(keyword.size())));
    } else if (small == "kd") {
      draft_.scene.materials[present(keyword)].rho = colour();
      draft_.origins[present(keyword)].rho_place = place(file_, line_);
      take(entry_.rho, Eigen::ArrayXd(colour()), keyword);
    } else if (small == "ke") {
      draft_.scene.materials[present(keyword)].exitance = colour();
      draft_.origins[present(keyword)].exitance_place = place(file_, line_);
      take(entry_.exitance, Eigen::ArrayXd(colour()), keyword);
    } else if (small == "map_kd") {
      if (auto use = picture(text, "Kd")) lay(draft_.origins[*material_].picture, *use, keyword);
    } else if (small == "map_ke") {
      if (auto use = picture(text, "Ke"))
        lay(draft_.origins[*material_].exitance_picture, *use, keyword);
    } else if (small == "emissivity" || small == "temperature" || small == "net_flux") {
      heat(small);
    } else {
      unused(keyword);
    }
  }

  /// A picture that multiplies Kd or Ke; none if the file is not there. The file's name is all that
  /// follows the options.
  std::optional<PictureUse> picture(std::string_view text, const char* multiplied) {
    PictureUse use;
    std::size_t word = 1;
    while (word < words_.size() && words_[word].starts_with('-')) {
      const std::string_view option = words_[word++];
      if (option == "-clamp" && word < words_.size() && words_[word] == "on")
        warn("-clamp is not used: pictures repeat");
      if (option == "-s" || option == "-o")
        (option == "-s" ? use.scale : use.offset) = place_numbers(word);
      else
        while (word < words_.size() && is_value(words_[word])) ++word;
    }
    if (word == words_.size())
      fail(file_, line_, fmt::format("map_{} does not name a file", multiplied));
    const std::string_view name =
        text.substr(static_cast<std::size_t>(words_[word].data() - text.data()));
    present(words_[0]);
    const std::filesystem::path path = find_picture(file_, name);
    if (path.empty()) {
      warn(fmt::format("there is no picture {}: the material {} has its {} alone, everywhere",
                       in_quotes(name), in_quotes(material_name()), multiplied));
      return std::nullopt;
    }
    std::shared_ptr<const Texture>& known = textures_[path];
    if (!known) {
      known = std::make_shared<const Texture>(read_texture(path, read_bytes(path)));
      draft_.files.push_back(path);
    }
    use.texture = known;
    return use;
  }

  static bool is_value(std::string_view word) {
    return word == "on" || word == "off" || parse_double(word).has_value();
  }

  /// One to three numbers, of which the first two count; `word` moves behind them.
  Vec2 place_numbers(std::size_t& word) const {
    std::vector<double> values;
    while (word < words_.size() && values.size() < 3 && parse_double(words_[word]))
      values.push_back(finite_number(words_[word++], file_, line_));
    if (values.empty()) fail(file_, line_, "-s and -o need numbers");
    return {values[0], values.size() > 1 ? values[1] : values[0]};
  }

  /// Ours, by the words of materials files; other programs pass over them.
  void heat(const std::string& keyword) {
    present(keyword);
    heat_line_ = line_;
    const Rgb value = colour();
    if (keyword == "emissivity") return take(entry_.emissivity, Eigen::ArrayXd(value), keyword);
    if (words_.size() != 2) fail(file_, line_, fmt::format("{} is a single number", keyword));
    take(keyword == "temperature" ? entry_.temperature : entry_.net_flux, double{value[0]},
         keyword);
  }

  /// What a statement says of the material; of several the last one counts, which is said where
  /// they differ.
  template <class Value>
  void take(std::optional<Value>& said, const Value& value, std::string_view keyword) {
    if (said && !is_same(*said, value)) warn_of_second(keyword);
    said = value;
  }

  void lay(std::optional<PictureUse>& said, const PictureUse& use, std::string_view keyword) {
    if (said &&
        !(said->texture == use.texture && said->scale == use.scale && said->offset == use.offset))
      warn_of_second(keyword);
    said = use;
  }

  static bool is_same(double a, double b) { return a == b; }
  static bool is_same(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) { return (a == b).all(); }

  void warn_of_second(std::string_view keyword) {
    warn(fmt::format("material {} has another {} before; the last one counts",
                     in_quotes(material_name()), keyword));
  }

  void start_material(std::string_view name) {
    if (name.empty()) fail(file_, line_, "newmtl does not name a material");
    const auto id = static_cast<std::size_t>(material_id(draft_, std::string(name)));
    if (!defined_.insert(id).second)
      warn(
          fmt::format("material {} is defined again; the last definition counts", in_quotes(name)));
    Material& material = draft_.scene.materials[id];
    material = Material{};
    material.name = name;
    draft_.origins[id] = {};
    draft_.origins[id].name = material.name;
    entry_ = {};
    heat_line_ = 0;
    material_ = id;
  }

  void finish_material() {
    if (material_) complete(draft_.scene.materials[*material_], draft_.origins[*material_]);
    const bool needs_rho = material_ && draft_.origins[*material_].rho_place.empty() &&
                           !draft_.origins[*material_].heat.is_adiabatic;
    if (needs_rho) {
      const Material& material = draft_.scene.materials[*material_];
      draft_.warnings.push_back(
          fmt::format("{}: material {} has no Kd; its reflectance is taken as {}", file_.string(),
                      in_quotes(material.name), material.rho[0]));
    }
    material_.reset();
  }

  void complete(Material& material, MaterialOrigin& origin) {
    if (origin.exitance_picture && origin.exitance_place.empty()) {
      material.exitance.setOnes();
      origin.exitance_place = place(file_, line_);
      entry_.exitance = material.exitance;
    }
    if (origin.exitance_picture && material.exitance.isZero(0))
      draft_.warnings.push_back(
          fmt::format("{}: material {} has a picture map_Ke, but its Ke, which is multiplied by "
                      "it, is 0: it does not shine",
                      file_.string(), in_quotes(material.name)));
    if (heat_line_ > 0) {
      require_consistent(entry_, file_, heat_line_, "material " + in_quotes(material.name));
      const MaterialOrigin pictures = origin;  // whose use is decided with heat known
      apply_entry(entry_, place(file_, heat_line_), material, origin);
      origin.picture = pictures.picture;
      origin.exitance_picture = pictures.exitance_picture;
    }
    if (origin.picture && origin.rho_place.empty()) {
      material.rho.setOnes();
      origin.rho_place = place(file_, line_);
    }
  }

  std::size_t present(std::string_view keyword) const {
    if (!material_) fail(file_, line_, fmt::format("{} comes before any newmtl", keyword));
    return *material_;
  }

  /// One number stands for all channels.
  Rgb colour() const {
    if (words_.size() > 1 && (words_[1] == "spectral" || words_[1] == "xyz"))
      fail(file_, line_,
           fmt::format("{} {} is not supported; give red, green and blue", words_[0], words_[1]));
    if (words_.size() != 2 && words_.size() != 4)
      fail(file_, line_,
           fmt::format("{} has {} numbers; it needs 3 (red, green, blue) or 1", words_[0],
                       words_.size() - 1));
    Rgb value;
    for (int c = 0; c < 3; ++c)
      value[c] =
          number(words_[words_.size() == 2 ? 1 : static_cast<std::size_t>(c) + 1], file_, line_);
    return value;
  }

  void unused(std::string_view keyword) {
    const auto is_one_of = [&](std::initializer_list<std::string_view> names) {
      return std::find(names.begin(), names.end(), keyword) != names.end();
    };
    // How a surface shines and looks up close does not concern a diffuse one.
    if (is_one_of({"Ka", "Ks", "Ns", "Ni", "Tf", "illum", "sharpness", "map_Ka", "map_Ks", "map_Ns",
                   "map_Bump", "map_bump", "bump", "disp", "decal", "refl", "norm", "map_aat"}))
      return;
    std::string why;
    if (keyword == "d" || keyword == "Tr" || keyword == "map_d") {
      const std::optional<double> value = parse_double(words_.back());
      if (value && *value == (keyword == "Tr" ? 0.0 : 1.0)) return;
      why = "all surfaces are opaque; transparency is not used";
    } else {
      why = fmt::format("statements that begin with {} are not used", in_quotes(keyword));
    }
    constexpr std::size_t most = 10;  // a file of another kind has thousands
    if (warned_.size() < most && warned_.insert(std::string(keyword)).second) warn(why);
  }

  const std::string& material_name() const {
    static const std::string none;
    return material_ ? draft_.scene.materials[*material_].name : none;
  }

  void warn(const std::string& sentence) {
    draft_.warnings.push_back(place(file_, line_) + ": " + sentence);
  }

  std::filesystem::path file_;
  SceneDraft& draft_;
  std::vector<std::string_view> words_;
  int line_ = 0;
  std::optional<std::size_t> material_;
  MaterialEntry entry_;  ///< what is said of it
  int heat_line_ = 0;    ///< the last that says something of heat; 0: none
  std::set<std::size_t> defined_;
  std::map<std::filesystem::path, std::shared_ptr<const Texture>> textures_;
  std::set<std::string> warned_;
};

}  // namespace

void read_mtl(const std::filesystem::path& path, SceneDraft& draft) {
  MtlReader(path, draft).read();
}

}  // namespace halfshade::reading
