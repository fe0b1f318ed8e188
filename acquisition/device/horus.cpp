// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/horus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

namespace vitrine::acquisition::horus {
namespace {

// Returns the finite number that follows the first `name` in `text`.
std::optional<double> number_after(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(name);
  if (at == std::string_view::npos) return std::nullopt;
  text.remove_prefix(at + name.size());
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return value;
}

Reply parse_brackets(std::string_view line) {
  const std::string text(line);
  if (line.find("unlock") != std::string_view::npos && line.find('$') != std::string_view::npos)
    return {.kind = ReplyKind::kAlarm, .text = text};
  if (line.starts_with("[G")) {
    if (const auto feed = number_after(line, " F")) return {ReplyKind::kModes, text, *feed};
  }
  const std::size_t end = line.find(':');
  if (std::isdigit(static_cast<unsigned char>(line[1])) != 0 && end != std::string_view::npos)
    return {.kind = ReplyKind::kVersion, .text = text.substr(1, end - 1)};
  return {.kind = ReplyKind::kRemark, .text = text};
}

}  // namespace

double longest(double degrees, int speed) {
  const double way = std::abs(degrees);
  return 2 * way / speed + std::min(way, 360.0) / kSlowestSpeed;
}

std::string turn(double degrees, int speed) {
  return fmt::format("G1 X{:.4f} F{}", degrees, speed);
}
std::string speed(int degrees_per_second) {
  return fmt::format("G1 F{}", degrees_per_second);
}
std::string laser(int which, bool on) {
  return fmt::format("M{}T{}", on ? 71 : 70, which);
}

Reply parse(std::string_view line) {
  const std::string text(line);
  if (line == "ok") return {.kind = ReplyKind::kOk};
  if (line.starts_with("error:")) return {.kind = ReplyKind::kRefusal, .text = text};
  if (line.starts_with("ALARM:")) return {.kind = ReplyKind::kAlarm, .text = text};
  if (line.ends_with("['$' for help]"))
    return {.kind = ReplyKind::kBanner, .text = text.substr(0, text.find(" ['"))};
  if (line.starts_with('[') && line.ends_with(']')) return parse_brackets(line);
  if (line.starts_with('<') && line.ends_with('>')) {
    if (const auto at = number_after(line, "MPos:")) return {ReplyKind::kStatus, text, *at};
  }
  return {.kind = ReplyKind::kUnknown, .text = text};
}

}  // namespace vitrine::acquisition::horus
