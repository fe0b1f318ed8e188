// SPDX-License-Identifier: Apache-2.0
// The client side of the protocol pmesh.v1: fetches a model at the requested detail. Opens as many
// connections as needed.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "server/cli/client/model_url.h"
#include "server/cli/client/partial_model.h"
#include "server/metadata/presentation.h"
#include "server/stream/message.h"
#include "server/stream/server_message.h"

namespace vitrine::server {

struct FetchOptions {
  ModelUrl url;
  std::string token;                   // empty if no token is sent
  std::optional<DetailTarget> target;  // nullopt for the whole model
  // Output file. Received data is kept beside it in OUT.HASH.part.
  std::filesystem::path out;
  // Called when the model's head (Manifest::head_bytes()) or a chunk has arrived completely.
  std::function<void(const PartialModel&)> on_progress = {};
};

struct Fetched {
  PartialModel model;
  double seconds = 0;          // time from the first connection until the request was met
  std::uint64_t received = 0;  // payload bytes received in this run
  std::optional<PromiseMessage> promise;  // the last `promise` message of the server
  Presentation presentation = {};         // how the server presents the model
};

// Fetches a model. Connects again if the server stops (close code 1012) or the connection is lost,
// but gives up if no data has arrived for kReconnectTimeout. Fails with kIo if the server cannot be
// reached or files cannot be written. Fails with kBadInput if the server violates pmesh.v1, and
// with kState if the model does not exist or has changed meanwhile. Keeps received data for the
// next run.
Expected<Fetched> fetch(const FetchOptions& options);

}  // namespace vitrine::server
