// SPDX-License-Identifier: Apache-2.0
#include "codec/import/obj_colours.h"

#include <charconv>

#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {
namespace {

constexpr Colour kUnpainted{255, 255, 255};

}  // namespace

void ObjColours::add(std::size_t vertex, std::span<const float> numbers) {
  if (numbers.size() < 3) return;  // a single extra number is the weight w, not a colour
  const auto last = numbers.last<3>();
  stated_.resize(vertex, kNoColour);
  stated_.push_back({last[0], last[1], last[2]});
  if (numbers.size() == 3) return;
  first_of_four_.resize(vertex);
  first_of_four_.push_back(numbers[0]);
  ++fours_;
  all_first_are_one_ = all_first_are_one_ && numbers[0] == 1;
  all_last_are_one_ = all_last_are_one_ && (numbers[3] == 1 || numbers[3] == 255);
}

void ObjColours::read_comment(std::string_view comment) {
  constexpr std::string_view kKeyword = "#MRGB";
  constexpr std::size_t kDigits = 8;
  if (!comment.starts_with(kKeyword)) return;
  comment.remove_prefix(
      std::min(comment.find_first_not_of(" \t", kKeyword.size()), comment.size()));
  for (; comment.size() >= kDigits; comment.remove_prefix(kDigits)) {
    std::uint32_t word = 0;
    const char* end = comment.data() + kDigits;
    if (std::from_chars(comment.data(), end, word, 16).ptr != end) return;
    painted_.push_back({static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 8),
                        static_cast<std::uint8_t>(word)});
  }
}

// Corrects colours that turn out to be r g b a. For each such vertex, the last three numbers, g b
// a, were stored as the colour; replaces them by r g b.
void ObjColours::put_opacity_away() {
  for (std::size_t v = 0; v < first_of_four_.size(); ++v) {
    const auto [g, b, a] = stated_[v];
    stated_[v] = {first_of_four_[v], g, b};
  }
}

std::vector<Colour> ObjColours::take(std::size_t vertices, std::vector<std::string>& repairs) {
  if (stated_.empty()) {
    if (painted_.size() < vertices)
      repairs.push_back(report_uncoloured(vertices - painted_.size()));
    painted_.resize(vertices, kUnpainted);
    return std::move(painted_);
  }
  stated_.resize(vertices, kNoColour);
  if (fours_ > 0 && is_opacity_last()) {
    put_opacity_away();
    repairs.push_back("opacity of " + counted(fours_, "vertex colour") +
                      " not carried; set it in a material if it matters");
  } else if (fours_ > 0) {
    repairs.push_back(counted(fours_, "line") +
                      " of four numbers after x y z read as w r g b; write x y z r g b if the "
                      "numbers are r g b and opacity");
  }
  return to_colours(stated_, repairs);
}

}  // namespace vitrine::inline codec
