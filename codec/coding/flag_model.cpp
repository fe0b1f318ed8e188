// SPDX-License-Identifier: Apache-2.0
#include "codec/coding/flag_model.h"

#include "codec/coding/trained_tables.h"

namespace vitrine::inline codec {

FlagModel::FlagModel() {
  trained::load(trained::kFlagBits, bits_);
}

}  // namespace vitrine::inline codec
