// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/correspondences.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

namespace vitrine::acquisition {
namespace {

constexpr std::string_view kHeader = "u,v,x,y,pose";
constexpr std::size_t kMostPoints = 1'000'000;

// Returns the text in `rest` before the first `end`. Removes that text and `end` from `rest`.
std::string_view take(std::string_view& rest, char end) {
  const std::size_t at = rest.find(end);
  const std::string_view taken = rest.substr(0, at);
  rest.remove_prefix(at == rest.npos ? rest.size() : at + 1);
  return taken;
}

std::string_view take_line(std::string_view& rest) {
  std::string_view line = take(rest, '\n');
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

template <class Number>
bool parse(std::string_view text, Number& number) {
  while (text.starts_with(' '))
    text.remove_prefix(1);
  while (text.ends_with(' '))
    text.remove_suffix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(double(number));
}

bool parse(std::string_view line, Correspondence& point) {
  for (double* value : {&point.u, &point.v, &point.at.x, &point.at.y}) {
    if (!parse(take(line, ','), *value)) return false;
  }
  return parse<int>(line, point.pose);
}

}  // namespace

Expected<std::vector<Correspondence>> read_correspondences(std::string_view csv,
                                                           const std::string& name) {
  if (const std::string_view header = take_line(csv); header != kHeader) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{}, line 1: expected \"{}\"; put that line first", name, kHeader));
  }
  std::vector<Correspondence> points;
  for (std::size_t number = 2; !csv.empty(); ++number) {
    Correspondence point;
    if (!parse(take_line(csv), point)) {
      return fail(ErrorCode::kBadInput,
                  fmt::format("{}, line {}: expected four numbers and a whole number, separated "
                              "by commas; correct the line",
                              name, number));
    }
    if (points.size() == kMostPoints) {
      return fail(ErrorCode::kLimit,
                  fmt::format("{} has more than {} points; leave some out", name, kMostPoints));
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace vitrine::acquisition
