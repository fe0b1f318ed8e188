// SPDX-License-Identifier: Apache-2.0
#include "server/cli/report/markup.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "codec/core/html.h"

namespace vitrine::server {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD", kThinSpace = "\xE2\x80\xAF";

std::string utf8(std::string_view bytes) {
  using nlohmann::json;
  const std::string text = json(bytes).dump(-1, ' ', false, json::error_handler_t::replace);
  return json::parse(text).get<std::string>();
}

std::string data(const std::string& value, const std::string& text) {
  return fmt::format("<data value=\"{}\">{}</data>", value, text);
}

}  // namespace

std::string escaped(std::string_view bytes) {
  std::string printable;
  for (const char c : utf8(bytes)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      printable += kReplacement;
    } else {
      printable += c;
    }
  }
  return escape_html(printable);
}

std::string base64(std::span<const std::uint8_t> bytes) {
  // Adds one byte, because OpenSSL appends a null byte.
  std::string out((bytes.size() + 2) / 3 * 4 + 1, '\0');
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()), bytes.data(),
                                   static_cast<int>(bytes.size()));
  out.resize(static_cast<std::size_t>(size));
  return out;
}

std::string count_text(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3;)
    digits.insert(at -= 3, kThinSpace);
  return digits;
}

std::string bytes_text(std::uint64_t bytes) {
  static constexpr std::array<const char*, 4> kUnits = {"kB", "MB", "GB", "TB"};
  if (bytes < 1'000)
    return fmt::format(
        "{}\xC2\xA0"
        "bytes",
        bytes);
  double size = static_cast<double>(bytes) / 1'000;
  std::size_t unit = 0;
  for (; size >= 999.5 && unit + 1 < kUnits.size(); ++unit)
    size /= 1'000;
  return fmt::format("{}\xC2\xA0{}", significant(size), kUnits[unit]);
}

std::string significant(double x) {
  if (!(x > 0)) return "0";
  if (x >= 999.5) return count_text(static_cast<std::uint64_t>(std::llround(std::min(x, 9e18))));
  const int decimals = 2 - static_cast<int>(std::floor(std::log10(x * 1.0005)));
  return fmt::format("{:.{}f}", x, std::clamp(decimals, 0, 15));
}

std::string count_data(std::uint64_t count) {
  return data(std::to_string(count), count_text(count));
}

std::string number_data(double x) {
  return data(fmt::format("{}", x), significant(x));
}

}  // namespace vitrine::server
