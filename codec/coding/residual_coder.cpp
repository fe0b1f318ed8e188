// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/residual_coder.h"

#include "codec/coding/trained_tables.h"

namespace vitrine::inline codec {

ResidualCoder::ResidualCoder() {
  trained::load(trained::kResidualBits, bits_);
}

}  // namespace vitrine::inline codec
