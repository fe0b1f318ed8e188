// SPDX-License-Identifier: Apache-2.0
// What an operator asks to be made of an upload.
#pragma once

#include "server/jobs/build_child.h"
#include "server/jobs/order_fields.h"
#include "server/store/uploads.h"

namespace vitrine {

struct ModelOrder {
  UploadId upload;
  ModelMetadata metadata;
  bool publish = false;            // else a draft comes of it
  std::optional<ModelId> replace;  // the model whose place it takes; whose texts, too, where none
                                   // are given
  std::string webhook;             // a URL that is told of the end; empty: none

  // Of a mesh; a .pmesh has its own.
  int bits = 0;  // as in BuildOptions
  Placement placement = Placement::kMidpoint;
  std::string unit;  // of kLengthUnits; empty: what the file states
  bool z_is_up = false;
};

// All faults at once; a field that is not known is one.
tl::expected<ModelOrder, FieldFaults> parse_model_order(const nlohmann::json& body);

// As it is kept until it is carried out: parse_model_order() reads it.
std::string to_json_text(const ModelOrder& order);

}  // namespace vitrine
