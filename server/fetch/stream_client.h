// SPDX-License-Identifier: Apache-2.0
// The client's end of pmesh.v1: fetches a model to a wish, over as many connections as it takes.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "server/fetch/model_url.h"
#include "server/fetch/partial_model.h"
#include "server/stream/message.h"
#include "server/stream/server_message.h"

namespace vitrine {

struct FetchOptions {
  ModelUrl url;
  std::string token;          // empty: none
  std::optional<Wish> wish;   // nothing: the whole model
  std::filesystem::path out;  // beside it is what has come: OUT.HASH.part
  std::function<void(const PartialModel&)> on_progress = {};  // a chunk or the head has come
};

struct Fetched {
  PartialModel model;
  double seconds = 0;                     // from the first connection on to the wish
  std::uint64_t received = 0;             // payload bytes of this run
  std::optional<PromiseMessage> promise;  // the newest
};

// Connects anew where the server goes away (close 1012, a lost connection), until nothing more has
// come for kPatience. Fails with kIo where it cannot be reached or files cannot be written, with
// kBadInput where what it sends is not pmesh.v1, with kState where the model is not there or has
// changed meanwhile; what has come stays for the next run.
Expected<Fetched> fetch(const FetchOptions& options);

}  // namespace vitrine
