// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/fetch_pictures.h"

#include <fmt/core.h>

#include "server/remote/remote_server.h"

namespace vitrine::server {
namespace {

std::string block_url(const ModelUrl& model, const Sha256& name) {
  return fmt::format("{}://{}{}/chunks/{}", model.is_encrypted ? "https" : "http",
                     model.authority(), model.resource(), to_hex(name));
}

// Returns the body of the response, which may have at most `most` bytes.
Expected<std::vector<std::uint8_t>> get(RemoteServer& server, const FetchOptions& options,
                                        std::string url, std::uint64_t most) {
  std::vector<std::uint8_t> body;
  RemoteRequest request{.url = std::move(url)};
  if (!options.token.empty()) request.fields = {"Authorization: Bearer " + options.token};
  request.take = [&](std::span<const std::uint8_t> part) {
    if (part.size() > most - body.size()) return false;
    body.insert(body.end(), part.begin(), part.end());
    return true;
  };
  const auto answer = server.ask(request);
  if (!answer) {
    return fail(answer.error().code,
                fmt::format("a picture of the texture does not arrive: {}; try again to continue, "
                            "the data received so far is kept",
                            answer.error().message));
  }
  if (answer->status == 200) return body;
  return fail(ErrorCode::kState,
              fmt::format("the server refuses a picture of the texture with status {}; run the "
                          "command again",
                          answer->status));
}

}  // namespace

Expected<std::uint64_t> fetch_pictures(const FetchOptions& options,
                                       std::span<const std::size_t> pictures, PartialModel& model) {
  RemoteServer server;
  std::uint64_t received = 0;
  for (const std::size_t i : pictures) {
    if (model.holds_picture(i)) continue;
    const PictureInfo& picture = model.manifest()->texture.pictures[i];
    const auto bytes = get(server, options, block_url(options.url, picture.sha256), picture.length);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto added = model.add_picture(i, *bytes); !added) return tl::unexpected(added.error());
    received += bytes->size();
    if (options.on_progress) options.on_progress(model);
  }
  return received;
}

Expected<std::uint64_t> fetch_optional_blocks(const FetchOptions& options, PartialModel& model) {
  RemoteServer server;
  std::uint64_t received = 0;
  for (const OptionalBlock& block : model.manifest()->optional_blocks) {
    if (model.holds(block)) continue;
    const auto bytes = get(server, options, block_url(options.url, block.sha256), block.length);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto added = model.add(block, *bytes); !added) return tl::unexpected(added.error());
    received += bytes->size();
  }
  return received;
}

}  // namespace vitrine::server
