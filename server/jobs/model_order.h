// SPDX-License-Identifier: Apache-2.0
// Reads and writes requests to make a model from an upload.
#pragma once

#include "server/jobs/order_fields.h"
#include "server/sandbox/build_child.h"
#include "server/store/uploads.h"

namespace vitrine::server {

struct ModelOrder {
  UploadId upload;
  ModelMetadata metadata;
  bool is_public = false;  // whether the model is published at once; else it is a draft
  // The model to replace. Its metadata stays, except for texts that `metadata` contains.
  std::optional<ModelId> replace;
  std::string webhook;  // URL to call when the job ends; empty: none

  // Options for building the model from a mesh. They do not apply to a .pmesh file.
  int bits = 0;  // see BuildOptions::bits
  Placement placement = Placement::kMidpoint;
  std::string unit;  // one of kLengthUnits; empty: the unit in the file
  bool z_is_up = false;

  // Repairs and losses that the client's build of an uploaded .pmesh file reported, one line for
  // each kind. Unused if a mesh was uploaded, because the server then builds the model itself.
  std::string repairs;
};

// Parses a request. Returns either the order or all faults of the request. An unknown field is also
// a fault.
tl::expected<ModelOrder, FieldFaults> parse_model_order(const nlohmann::json& body);

// Formats an order as JSON, which the job's record stores. parse_model_order() parses it.
std::string to_json_text(const ModelOrder& order);

}  // namespace vitrine::server
