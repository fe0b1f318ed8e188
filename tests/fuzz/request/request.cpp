// SPDX-License-Identifier: Apache-2.0
// Passes arbitrary bytes of a client through all code that reads a request before the request's
// handler runs. Reads the bytes once as a whole and once in two pieces. Both must give the same
// request, or both must give none.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/api/path_parameters.h"
#include "server/api/routes.h"
#include "server/http/beast.h"
#include "server/messages/client.h"
#include "server/messages/conditional.h"
#include "server/messages/framing.h"
#include "server/messages/query.h"
#include "server/messages/router.h"

namespace {

using namespace vitrine;

using namespace vitrine::server;
using Parser = beast::http::request_parser<beast::http::string_body>;

void check(bool holds) {
  if (!holds) std::abort();
}

struct Read {
  std::string target;
  RequestHeader header;
  std::string body;
  std::size_t size = 0;  // length of the request, in bytes
};

// Passes `text` to the parser as a connection would: the first `piece` bytes, then the rest.
// Returns nullopt if `text` does not begin with a complete request that the daemon accepts.
std::optional<Read> read(std::string_view text, std::size_t piece) {
  Parser parser;
  parser.header_limit(16 * 1024);
  parser.body_limit(64 * 1024);
  parser.eager(true);
  std::size_t used = 0;
  for (const std::size_t known : {piece, text.size()}) {
    while (!parser.is_done()) {
      boost::system::error_code error;
      const std::size_t taken =
          parser.put(boost::asio::buffer(text.data() + used, known - used), error);
      used += taken;
      if (error && error != beast::http::error::need_more) return std::nullopt;
      if (error || taken == 0) break;
    }
  }
  if (!parser.is_done() || !framing_fault(parser.get()).empty()) return std::nullopt;
  const auto target = parser.get().target();
  return Read{{target.data(), target.size()}, parser.get().base(), parser.get().body(), used};
}

// Returns the routes of the public interface, without their handlers.
std::vector<Route> public_paths() {
  std::vector<Route> routes;
  for (const ApiRoute& route : public_routes())
    routes.push_back({.method = route.method, .path = route.path});
  return routes;
}

void use(const Read& read) {
  static const Router router(public_paths(), parameter_patterns());
  static const Networks proxies = Networks::parse("10.0.0.0/8").value();
  for (const auto& field : read.header)
    check(field.value().find_first_of("\r\n") == beast::string_view::npos);
  const std::string address = client_of({"10.0.0.1", false}, read.header, proxies).address;
  check(is_address(address));
  const auto target = split_target(read.target);
  if (!target) return;
  if (const auto match = router.match(target->path)) check(match->index < router.routes().size());
  if (const auto query = Query::parse(target->query))
    check(query->get("q").value_or("").size() < 1 << 17);
  Response response;
  response.etag = "\"tag\"";
  response.body = std::string(100, 'x');
  const Response answer = apply_conditions(read.header, std::move(response), "id");
  check(body_size(answer.body) <= 400);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto whole = read(text, text.size());
  const auto parts = read(text, std::min<std::size_t>(data[0], text.size()));
  check(whole.has_value() == parts.has_value());
  if (!whole) return 0;
  check(whole->size == parts->size && whole->target == parts->target && whole->body == parts->body);
  use(*whole);
  return 0;
}
