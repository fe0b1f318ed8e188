// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/residual_coder.h"

#include "codec/progressive/trained_tables.h"

namespace vitrine {

ResidualCoder::ResidualCoder() {
  trained::load(trained::kResidualBits, bits_);
}

}  // namespace vitrine
