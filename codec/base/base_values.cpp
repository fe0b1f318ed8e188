// SPDX-License-Identifier: Apache-2.0
#include "codec/base/base_values.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "codec/base/rans.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {
namespace {

// The three components of a value, as integers modulo 2^32.
using Value = std::array<std::uint32_t, 3>;

enum Prediction : std::uint8_t { kParallelogram = 1, kSeveralParallelograms = 4 };
constexpr std::uint8_t kWrapped = 1, kCompressed = 1;
constexpr std::size_t kMostParallelograms = 4;

// The range of all values of the attribute. A prediction plus its correction wraps around at the
// ends of this range (Draco's wrap transform).
struct Range {
  std::int32_t low, high;

  bool is_valid() const {
    const std::int64_t size = std::int64_t{high} - low;
    return size >= 0 && size < std::numeric_limits<std::int32_t>::max();
  }
  std::uint32_t corrected(std::uint32_t predicted, std::uint32_t correction) const {
    const std::int32_t clamped = std::clamp(static_cast<std::int32_t>(predicted), low, high);
    const auto sum = static_cast<std::uint32_t>(clamped) + correction;
    const auto value = static_cast<std::int32_t>(sum);
    const auto size = static_cast<std::uint32_t>(high - low + 1);
    return value > high ? sum - size : value < low ? sum + size : sum;
  }
};

// One bit for each parallelogram of a vertex: 1 excludes this parallelogram from the prediction.
// `left` is the number of bits not read yet.
struct Exclusions {
  std::uint32_t left = 0;
  std::optional<RansBits> bits;

  bool read(ByteReader& in) {
    left = in.varint32();
    if (left != 0) bits.emplace(in);
    return in.is_ok() && (left == 0 || bits->is_ok());
  }
};

// Turns corrections into values. Predicts each value, in coded order, and adds its correction.
class Predictor {
 public:
  Predictor(const CornerTable& table, const CodedOrder& order,
            std::vector<std::uint32_t> corrections)
      : table_(table), order_(order), values_(std::move(corrections)) {}

  // Reads the data that follows the corrections: the exclusion bits if `has_several`, and the
  // range.
  bool read(ByteReader& in, bool has_several) {
    has_several_ = has_several;
    bool is_ok = true;
    for (std::size_t i = 0; has_several && i < kMostParallelograms; ++i)
      is_ok = is_ok && exclusions_[i].read(in);
    range_.low = static_cast<std::int32_t>(in.u32());
    range_.high = static_cast<std::int32_t>(in.u32());
    return is_ok && in.is_ok() && range_.is_valid();
  }

  // Computes all values. Returns false unless there is exactly one exclusion bit per parallelogram.
  bool predict_all() {
    Value predicted{};
    for (std::uint32_t i = 0; i < order_.corner.size(); ++i) {
      if (i != 0 && !predict(i, predicted)) return false;
      for (std::size_t k = 0; k < 3; ++k)
        of(i)[k] = range_.corrected(predicted[k], of(i)[k]);
    }
    return std::all_of(exclusions_.begin(), exclusions_.end(),
                       [](const Exclusions& some) { return some.left == 0; });
  }

  std::vector<Vec3i> by_vertex() const {
    std::vector<Vec3i> out;
    out.reserve(order_.rank.size());
    for (const std::uint32_t rank : order_.rank) {
      const std::uint32_t* value = of(rank);
      out.push_back({static_cast<std::int32_t>(value[0]), static_cast<std::int32_t>(value[1]),
                     static_cast<std::int32_t>(value[2])});
    }
    return out;
  }

 private:
  // Predicts value i as the mean over its parallelograms. A parallelogram counts if its other three
  // vertices have known values and no exclusion bit rules it out. If none counts, predicts value i
  // - 1.
  bool predict(std::uint32_t i, Value& out) {
    std::array<Value, kMostParallelograms> found;
    const std::size_t count = has_several_ ? find(i, found) : parallelogram(i, found[0]);
    std::int32_t used = 0;
    Value sum{};
    for (std::size_t j = 0; j < count; ++j) {
      if (has_several_) {
        Exclusions& exclusions = exclusions_[count - 1];
        if (exclusions.left == 0) return false;
        --exclusions.left;
        if (exclusions.bits->next()) continue;
      }
      ++used;
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += found[j][k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto total = static_cast<std::int32_t>(sum[k]);
      out[k] = used == 0 ? of(i - 1)[k] : static_cast<std::uint32_t>(total / used);
    }
    return true;
  }

  bool parallelogram(std::uint32_t i, Value& out) const {
    return parallelogram(i, order_.corner[i], out);
  }

  // Predicts value i from the parallelogram whose fourth vertex lies across the edge opposite to
  // corner c. Returns false if that edge is a boundary edge or one of the other three values is
  // unknown.
  bool parallelogram(std::uint32_t i, Corner c, Value& out) const {
    const Corner across = table_.opposite[c];
    if (across == kNoCorner) return false;
    const std::uint32_t far = rank(across), left = rank(next(across)), right = rank(prev(across));
    if (std::max({far, left, right}) >= i) return false;
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = of(left)[k] + of(right)[k] - of(far)[k];
    return true;
  }

  // Finds the parallelograms at the corners around a vertex. Starts at the first corner and goes
  // left. At a boundary, returns to the first corner and goes right.
  std::size_t find(std::uint32_t i, std::array<Value, kMostParallelograms>& out) const {
    const Corner first = order_.corner[i];
    std::size_t count = 0;
    bool is_left = true;
    for (Corner c = first; c != kNoCorner && count < out.size();) {
      count += parallelogram(i, c, out[count]);
      c = is_left ? table_.swing_left(c) : table_.swing_right(c);
      if (c == first) break;
      if (c == kNoCorner && is_left) {
        is_left = false;
        c = table_.swing_right(first);
      }
    }
    return count;
  }

  std::uint32_t* of(std::uint32_t i) { return &values_[3 * std::size_t{i}]; }
  const std::uint32_t* of(std::uint32_t i) const { return &values_[3 * std::size_t{i}]; }
  std::uint32_t rank(Corner c) const { return order_.rank[table_.vertex[c]]; }

  const CornerTable& table_;
  const CodedOrder& order_;
  // Three integers per vertex, in coded order: the correction at first, then the value.
  std::vector<std::uint32_t> values_;
  // Entry i holds the bits of vertices that have i + 1 parallelograms.
  std::array<Exclusions, kMostParallelograms> exclusions_;
  bool has_several_ = false;
  Range range_{};
};

}  // namespace

Expected<std::vector<Vec3i>> read_values(ByteReader& in, const CornerTable& table,
                                         const CodedOrder& order) {
  const std::uint8_t prediction = in.u8();
  if ((prediction != kParallelogram && prediction != kSeveralParallelograms) ||
      in.u8() != kWrapped || in.u8() != kCompressed)
    return fail(ErrorCode::kUnsupported,
                "the base mesh predicts its values in another way; build the model again");
  auto corrections = read_symbols(in, static_cast<std::uint32_t>(order.corner.size()));
  if (corrections.empty()) return damaged_base("its values are no symbols");
  // zigzag coding: even symbols are numbers >= 0, odd symbols are numbers < 0
  for (std::uint32_t& correction : corrections)
    correction = correction >> 1 ^ -(correction & 1);
  Predictor predictor(table, order, std::move(corrections));
  if (!predictor.read(in, prediction == kSeveralParallelograms) || !predictor.predict_all())
    return damaged_base("the predictions of its values are not complete");
  return predictor.by_vertex();
}

}  // namespace vitrine::inline codec
