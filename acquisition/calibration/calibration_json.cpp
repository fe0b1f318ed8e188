// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibration_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace vitrine::acquisition {

using Json = nlohmann::ordered_json;

namespace {

constexpr int kFormat = 1;
constexpr double kMostMm = 1e5, kMostPixels = 1e5;
constexpr std::size_t kMostText = 256, kMostCorners = 4096;

// Reads the members of one JSON object and keeps the first error. Values returned after an error
// are meaningless.
class Reader {
 public:
  Reader(const Json& object, std::string& fault) : object_(object), fault_(fault) {}

  double number(const char* key, double low, double high) {
    const Json* value = find(key, &Json::is_number);
    const double number = value == nullptr ? low : value->get<double>();
    if (!(number >= low && number <= high)) wrong(key);
    return number;
  }
  double within(const char* key, double most) { return number(key, -most, most); }

  int integer(const char* key, int low, int high) {
    const Json* value = find(key, &Json::is_number_integer);
    const double number = value == nullptr ? low : value->get<double>();
    if (number >= low && number <= high) return static_cast<int>(number);
    wrong(key);
    return low;
  }

  bool truth(const char* key) {
    const Json* value = find(key, &Json::is_boolean);
    return value != nullptr && value->get<bool>();
  }

  std::string text(const char* key) {
    const Json* value = find(key, &Json::is_string);
    std::string text = value == nullptr ? "" : value->get<std::string>();
    if (text.empty() || text.size() > kMostText) wrong(key);
    return text;
  }

  // Reads an array of number pairs. The number of pairs must lie between `least` and `most`.
  std::vector<std::pair<double, double>> pairs(const char* key, std::size_t least, std::size_t most,
                                               double bound) {
    const Json* value = find(key, &Json::is_array);
    std::vector<std::pair<double, double>> all;
    if (value == nullptr || value->size() < least || value->size() > most) {
      wrong(key);
      return all;
    }
    for (const Json& pair : *value) {
      const auto good = [&](const Json& n) {
        return n.is_number() && std::abs(n.get<double>()) <= bound;
      };
      if (!pair.is_array() || pair.size() != 2 || !good(pair[0]) || !good(pair[1])) {
        wrong(key);
        return all;
      }
      all.emplace_back(pair[0].get<double>(), pair[1].get<double>());
    }
    return all;
  }

  Reader inner(const char* key) {
    static const Json nothing = Json::object();
    const Json* value = find(key, &Json::is_object);
    return {value == nullptr ? nothing : *value, fault_};
  }

  // Reports an error if the object has a key that is not in `known`.
  void only(std::initializer_list<std::string_view> known) {
    for (const auto& [key, value] : object_.items()) {
      if (fault_.empty() && std::ranges::find(known, key) == known.end())
        fault_ = fmt::format("unknown key \"{}\"", key);
    }
  }

  void wrong(const char* key) {
    if (fault_.empty())
      fault_ = fmt::format("\"{}\" is missing, out of range or of the wrong type", key);
  }

 private:
  const Json* find(const char* key, bool (Json::*is)() const noexcept) {
    const auto found = object_.find(key);
    if (found != object_.end() && ((*found).*is)()) return &*found;
    wrong(key);
    return nullptr;
  }

  const Json& object_;
  std::string& fault_;
};

Json json_of(const TurntableAxis& axis) {
  return {{"a", axis.a},
          {"b", axis.b},
          {"offset", axis.offset},
          {"tilt", axis.tilt},
          {"clockwise", axis.is_clockwise}};
}

TurntableAxis read_axis(Reader in) {
  return {.a = in.within("a", kMostMm),
          .b = in.within("b", 1),
          .offset = in.within("offset", kMostMm),
          .tilt = in.within("tilt", 1),
          .is_clockwise = in.truth("clockwise")};
}

Json json_of(const SensorRegion& r) {
  return {{"x", r.x}, {"y", r.y}, {"width", r.width}, {"height", r.height}};
}

SensorRegion read_region(Reader in) {
  constexpr int kMost = 1 << 16;
  return {.x = in.integer("x", 0, kMost),
          .y = in.integer("y", 0, kMost),
          .width = in.integer("width", 1, kMost),
          .height = in.integer("height", 1, kMost)};
}

// Returns whether the polygon turns left at each corner. Also allows corners that are straight
// within single precision.
bool is_convex(std::span<const double> hull) {
  const std::size_t n = hull.size();
  for (std::size_t i = 0; i < n; i += 2) {
    const std::size_t j = (i + 2) % n, k = (i + 4) % n;
    const double du = hull[j] - hull[i], dv = hull[j + 1] - hull[i + 1];
    const double turn = du * (hull[k + 1] - hull[j + 1]) - dv * (hull[k] - hull[j]);
    if (!(turn > -1e-3 * (std::abs(du) + std::abs(dv)))) return false;
  }
  return true;
}

// Parses a JSON object. `remedy` is the end of the error message and says what to do next.
Expected<Json> parse_object(std::string_view text, const std::string& name,
                            std::string_view remedy) {
  Json object = Json::parse(text, nullptr, false);
  if (!object.is_discarded() && object.is_object()) return object;
  return fail(ErrorCode::kBadInput,
              fmt::format("{} is not a complete JSON object{}", name, remedy));
}

constexpr std::string_view kRestore =
    "; restore it from a backup, or remove it and calibrate again";
constexpr std::string_view kStateAxis =
    "; give a and offset (mm), b and tilt (mm per mm, -1 to 1) and clockwise (true or false)";

Unexpected faulty(const std::string& name, const std::string& fault) {
  return fail(ErrorCode::kBadInput, fmt::format("{}: {}{}", name, fault, kRestore));
}

}  // namespace

struct PlaneMapJson {
  static Json write(const PlaneMap& map) {
    Json terms = Json::array(), hull = Json::array();
    for (const PlaneMap::Terms& t : map.terms_)
      terms.push_back({t.x, t.y});
    for (std::size_t i = 0; i < map.hull_.size(); i += 2)
      hull.push_back({map.hull_[i], map.hull_[i + 1]});
    return {{"degree", map.degree_},
            {"condition", map.condition_},
            {"u", {{"centre", map.u_.centre}, {"half", map.u_.half}}},
            {"v", {{"centre", map.v_.centre}, {"half", map.v_.half}}},
            {"terms", terms},
            {"hull", hull}};
  }

  static PlaneMap read(Reader in) {
    PlaneMap map;
    map.degree_ = in.integer("degree", PlaneMap::kLeastDegree, PlaneMap::kMostDegree);
    map.condition_ = in.number("condition", 1, 1e6);
    map.u_ = read_interval(in.inner("u"));
    map.v_ = read_interval(in.inner("v"));
    const auto count = static_cast<std::size_t>((map.degree_ + 1) * (map.degree_ + 2) / 2);
    for (const auto& [x, y] : in.pairs("terms", count, count, kMostMm))
      map.terms_.push_back({x, y});
    for (const auto& [u, v] : in.pairs("hull", 3, kMostCorners, kMostPixels))
      map.hull_.insert(map.hull_.end(), {u, v});
    if (!is_convex(map.hull_)) in.wrong("hull");
    return map;
  }

 private:
  static PlaneMap::Interval read_interval(Reader in) {
    return {in.within("centre", kMostPixels), in.number("half", 1e-3, kMostPixels)};
  }
};

std::string to_json(const Calibration& c) {
  const Json all = {
      {"vitrine_calibration", kFormat},
      {"number", c.number},
      {"created", c.created},
      {"camera", c.camera},
      {"region", json_of(c.region)},
      {"map", PlaneMapJson::write(c.map)},
      {"axis", json_of(c.axis)},
      {"residuals_mm",
       {{"rms", c.residuals.rms}, {"p95", c.residuals.p95}, {"max", c.residuals.max}}},
      {"noise_mm", c.noise}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Expected<Calibration> calibration_from_json(std::string_view text, const std::string& name) {
  const auto object =
      parse_object(text, name, fmt::format(": it is damaged or truncated{}", kRestore));
  if (!object) return tl::unexpected(object.error());
  std::string fault;
  Reader in(*object, fault);
  in.integer("vitrine_calibration", kFormat, kFormat);
  if (!fault.empty()) return faulty(name, "this program cannot read it as a calibration");
  Calibration c;
  c.number = in.integer("number", 1, std::numeric_limits<int>::max());
  c.created = in.text("created");
  c.camera = in.text("camera");
  c.region = read_region(in.inner("region"));
  c.map = PlaneMapJson::read(in.inner("map"));
  c.axis = read_axis(in.inner("axis"));
  Reader residuals = in.inner("residuals_mm");
  c.residuals = {.rms = residuals.number("rms", 0, kMostMm),
                 .p95 = residuals.number("p95", 0, kMostMm),
                 .max = residuals.number("max", 0, kMostMm)};
  c.noise = in.number("noise_mm", 0, kMostMm);
  if (!fault.empty()) return faulty(name, fault);
  return c;
}

Expected<TurntableAxis> axis_from_json(std::string_view text, const std::string& name) {
  const auto object = parse_object(text, name, kStateAxis);
  if (!object) return tl::unexpected(object.error());
  std::string fault;
  Reader in(*object, fault);
  in.only({"a", "b", "offset", "tilt", "clockwise"});
  const TurntableAxis axis = read_axis(in);
  if (fault.empty()) return axis;
  return fail(ErrorCode::kBadInput, fmt::format("{}: {}{}", name, fault, kStateAxis));
}

}  // namespace vitrine::acquisition
