// SPDX-License-Identifier: Apache-2.0
// The vertex colours of an OBJ file. They are numbers after the coordinates, or #MRGB comments of
// ZBrush.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/import/stated_colours.h"

namespace vitrine::inline codec {

class ObjColours {
 public:
  // Takes the numbers after x, y and z of a vertex: none, w, r g b, w r g b or r g b a. Call this
  // for the vertices in ascending order.
  void add(std::size_t vertex, std::span<const float> numbers);

  // Reads the colours of a comment that starts with "#MRGB". Each vertex has eight hexadecimal
  // digits: a mask, red, green and blue. Ignores other comments.
  void read_comment(std::string_view comment);

  bool empty() const { return stated_.empty() && painted_.empty(); }

  // Returns one colour per vertex. Adds a line to `repairs` for each kind of doubtful or lost
  // colour.
  std::vector<Colour> take(std::size_t vertices, std::vector<std::string>& repairs);

 private:
  bool is_opacity_last() const { return !all_first_are_one_ && all_last_are_one_; }
  void put_opacity_away();

  std::vector<StatedColour> stated_;  // per vertex: the last three numbers after x y z
  std::vector<float> first_of_four_;  // per vertex: the first of four numbers after x y z
  std::vector<Colour> painted_;       // colours from #MRGB comments
  std::uint64_t fours_ = 0;           // number of vertices with four numbers
  bool all_first_are_one_ = true, all_last_are_one_ = true;
};

}  // namespace vitrine::inline codec
