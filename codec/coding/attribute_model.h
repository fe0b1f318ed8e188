// SPDX-License-Identifier: Apache-2.0
// Codes the difference in one attribute between the two vertices of a split, one channel at a time.
// The caller supplies a prediction, computed by predicted_difference() in surroundings.h.
#pragma once

#include <array>

#include "codec/coding/residual_coder.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

class AttributeModel {
 public:
  // Codes `truth`: the attribute value of the split vertex minus the value of the new vertex.
  // Returns the coded value. The model predicts `truth` as `difference` times a weight that is
  // learned online.
  template <class Coder>
  Vec3i code(Coder& coder, const Vec3& difference, Vec3i truth) {
    return {channels_[0].code(coder, difference.x, truth.x),
            channels_[1].code(coder, difference.y, truth.y),
            channels_[2].code(coder, difference.z, truth.z)};
  }

 private:
  struct ChannelModel {
    // The model's standard deviation follows the running mean square of the prediction error. This
    // mean is learned separately for eight size classes of the predicted difference.
    template <class Coder>
    std::int32_t code(Coder& coder, double difference, std::int32_t truth) {
      const double expected = product_ / square_ * difference;
      double& energy = energy_[static_cast<std::size_t>(
          std::clamp(exact::log2_bucket<0>(std::fabs(difference) + 0.25) + 2, 0, 7))];
      const std::int32_t d = coder_.code(coder, truth, expected, std::sqrt(energy + 0.05));
      const double error = d - expected;
      energy += (std::min(error * error, 1e6) - energy) / 24;
      product_ += difference * d;
      square_ += difference * difference;
      return d;
    }

    double product_ = 20, square_ = 40;
    std::array<double, 8> energy_ = {1, 1, 2, 4, 8, 16, 64, 256};
    ResidualCoder coder_;
  };

  std::array<ChannelModel, 3> channels_;
};

}  // namespace vitrine::inline codec
