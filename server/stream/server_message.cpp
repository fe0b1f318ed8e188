// SPDX-License-Identifier: Apache-2.0
#include "server/stream/server_message.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace vitrine::server {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

constexpr int kMaxNesting = 2;

OrderedJson json_of(const ModelMessage& message) {
  OrderedJson json = {{"type", "model"},
                      {"model", message.model},
                      {"sha256", message.sha256},
                      {"chunks", message.chunks},
                      {"head_bytes", message.head_bytes},
                      {"slice_bytes", message.slice_bytes},
                      {"credit", message.credit}};
  if (!message.presentation.empty()) json["presentation"] = message.presentation;
  return json;
}
OrderedJson json_of(const PromiseMessage& message) {
  return {{"type", "promise"},
          {"model", message.model},
          {"turn", message.turn},
          {"level", message.level},
          {"bytes", message.bytes},
          {"triangles", message.triangles},
          {"error", message.error},
          {"seconds", message.seconds},
          {"bytes_per_second", message.bytes_per_second},
          {"measured", message.is_measured}};
}
OrderedJson json_of(const DoneMessage& message) {
  return {{"type", "done"},
          {"model", message.model},
          {"turn", message.turn},
          {"bytes", message.bytes},
          {"triangles", message.triangles}};
}
OrderedJson json_of(const ClosedMessage& message) {
  return {{"type", "closed"}, {"model", message.model}, {"reason", message.reason}};
}

// Reads members of a JSON object and records whether all of them exist with the expected type.
class Members {
 public:
  explicit Members(const Json& json) : json_(json) {}

  template <class Count>
  void count(const char* name, Count& out) {
    const auto member = json_.find(name);
    is_complete_ = is_complete_ && member != json_.end() && member->is_number_unsigned() &&
                   member->get<std::uint64_t>() <= std::numeric_limits<Count>::max();
    if (is_complete_) out = static_cast<Count>(member->get<std::uint64_t>());
  }
  void number(const char* name, double& out) {
    const auto member = json_.find(name);
    is_complete_ = is_complete_ && member != json_.end() && member->is_number() &&
                   std::isfinite(member->get<double>());
    if (is_complete_) out = member->get<double>();
  }
  template <class Value>
  void value(const char* name, Json::value_t type, Value& out) {
    const auto member = json_.find(name);
    is_complete_ = is_complete_ && member != json_.end() && member->type() == type;
    if (is_complete_) out = member->get<Value>();
  }

  // Reads a text that servers of older versions do not send.
  void optional_text(const char* name, std::string& out) {
    if (json_.contains(name)) value(name, Json::value_t::string, out);
  }

  template <class Message>
  Expected<ServerMessage> message(Message message) const {
    if (is_complete_) return message;
    return fail(ErrorCode::kBadInput, "a message of the server lacks a member");
  }

 private:
  const Json& json_;
  bool is_complete_ = true;
};

Expected<ServerMessage> parse_model(Members members) {
  ModelMessage message;
  members.count("model", message.model);
  members.value("sha256", Json::value_t::string, message.sha256);
  members.count("chunks", message.chunks);
  members.count("head_bytes", message.head_bytes);
  members.count("slice_bytes", message.slice_bytes);
  members.count("credit", message.credit);
  members.optional_text("presentation", message.presentation);
  return members.message(std::move(message));
}

Expected<ServerMessage> parse_promise(Members members) {
  PromiseMessage message;
  members.count("model", message.model);
  members.count("turn", message.turn);
  members.count("level", message.level);
  members.count("bytes", message.bytes);
  members.count("triangles", message.triangles);
  members.number("error", message.error);
  members.number("seconds", message.seconds);
  members.number("bytes_per_second", message.bytes_per_second);
  members.value("measured", Json::value_t::boolean, message.is_measured);
  return members.message(message);
}

Expected<ServerMessage> parse_done(Members members) {
  DoneMessage message;
  members.count("model", message.model);
  members.count("turn", message.turn);
  members.count("bytes", message.bytes);
  members.count("triangles", message.triangles);
  return members.message(message);
}

Expected<ServerMessage> parse_closed(Members members) {
  ClosedMessage message;
  members.count("model", message.model);
  members.value("reason", Json::value_t::string, message.reason);
  return members.message(std::move(message));
}

}  // namespace

std::string to_json(const ServerMessage& message) {
  return std::visit([](const auto& one) { return json_of(one); }, message).dump();
}

Expected<ServerMessage> parse_server_message(std::string_view text) {
  const auto shallow = [](int depth, Json::parse_event_t, Json&) { return depth < kMaxNesting; };
  const Json json = Json::parse(text, shallow, /*allow_exceptions=*/false);
  const auto type = json.is_object() ? json.find("type") : json.end();
  if (json.is_object() && type != json.end()) {
    if (*type == "model") return parse_model(Members(json));
    if (*type == "promise") return parse_promise(Members(json));
    if (*type == "done") return parse_done(Members(json));
    if (*type == "closed") return parse_closed(Members(json));
  }
  return fail(ErrorCode::kBadInput, "the server's message is not one of pmesh.v1");
}

}  // namespace vitrine::server
