// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/flag_model.h"

#include "codec/progressive/trained_tables.h"

namespace vitrine {

FlagModel::FlagModel() {
  trained::load(trained::kFlagBits, bits_);
}

}  // namespace vitrine
