// SPDX-License-Identifier: Apache-2.0
#include "server/doctor/probe.h"

#include <curl/curl.h>
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cctype>
#include <ctime>

namespace vitrine {
namespace {

constexpr long kPatience = 10;  // seconds, for an answer

std::size_t take_body(char* bytes, std::size_t size, std::size_t count, void* to) {
  auto& body = static_cast<ProbeAnswer*>(to)->body;
  body.append(bytes, std::min(size * count, ProbeAnswer::kMost - body.size()));
  return size * count;
}

std::size_t take_field(char* bytes, std::size_t size, std::size_t count, void* to) {
  const std::string_view line(bytes, size * count);
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return line.size();
  std::string name(line.substr(0, colon));
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::size_t first = line.find_first_not_of(' ', colon + 1);
  const std::size_t end = line.find_last_not_of("\r\n") + 1;
  if (first < end) static_cast<ProbeAnswer*>(to)->fields[name] = line.substr(first, end - first);
  return line.size();
}

struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

// "Expire date:Feb  3 12:00:00 2027 GMT", of the server's own certificate, which comes first.
std::optional<double> days_left(CURL* curl) {
  curl_certinfo* chain = nullptr;
  curl_easy_getinfo(curl, CURLINFO_CERTINFO, &chain);
  if (chain == nullptr || chain->num_of_certs == 0) return std::nullopt;
  constexpr std::string_view kKey = "Expire date:";
  for (const curl_slist* line = chain->certinfo[0]; line != nullptr; line = line->next) {
    const std::string_view text = line->data;
    if (!text.starts_with(kKey)) continue;
    const std::time_t end = curl_getdate(line->data + kKey.size(), nullptr);
    if (end > 0) return std::difftime(end, std::time(nullptr)) / (24 * 3600);
  }
  return std::nullopt;
}

bool wait_for(CURL* curl, short events) {
  curl_socket_t socket = CURL_SOCKET_BAD;
  curl_easy_getinfo(curl, CURLINFO_ACTIVESOCKET, &socket);
  pollfd waiting{socket, events, 0};
  return ::poll(&waiting, 1, kPatience * 1000) == 1;
}

bool send_all(CURL* curl, std::string_view text) {
  while (!text.empty()) {
    std::size_t sent = 0;
    const CURLcode code = curl_easy_send(curl, text.data(), text.size(), &sent);
    if (code == CURLE_AGAIN && wait_for(curl, POLLOUT)) continue;
    if (code != CURLE_OK) return false;
    text.remove_prefix(sent);
  }
  return true;
}

// Up to the empty line; empty where that does not come.
std::string receive_head(CURL* curl) {
  constexpr std::size_t kLongest = 64 * 1024;
  std::string text;
  while (text.find("\r\n\r\n") == std::string::npos && text.size() < kLongest) {
    char bytes[4096];
    std::size_t taken = 0;
    const CURLcode code = curl_easy_recv(curl, bytes, sizeof bytes, &taken);
    if (code == CURLE_AGAIN && wait_for(curl, POLLIN)) continue;
    if (code != CURLE_OK || taken == 0) return {};
    text.append(bytes, taken);
  }
  return text;
}

}  // namespace

struct Probe::Handle {
  CURL* curl = (curl_global_init(CURL_GLOBAL_DEFAULT), curl_easy_init());
  char fault[CURL_ERROR_SIZE] = "";
  ~Handle() { curl_easy_cleanup(curl); }

  void prepare(const std::string& url) {
    curl_easy_reset(curl);
    curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
    curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(curl, CURLOPT_TIMEOUT, kPatience);
    curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, fault);
    *fault = '\0';
  }
  Unexpected failed(const std::string& url, CURLcode code) const {
    return fail(ErrorCode::kIo, fmt::format("{}: {}; check the address and the network", url,
                                            *fault != '\0' ? fault : curl_easy_strerror(code)));
  }
};

Probe::Probe(std::string origin)
    : origin_(std::move(origin)), handle_(std::make_unique<Handle>()) {}

Probe::~Probe() = default;

Expected<ProbeAnswer> Probe::ask(const std::string& target, const std::vector<std::string>& fields,
                                 const std::string& method) {
  CURL* curl = handle_->curl;
  ProbeAnswer answer;
  std::unique_ptr<curl_slist, FreeList> list;
  for (const std::string& field : fields)
    list.reset(curl_slist_append(list.release(), field.c_str()));
  handle_->prepare(origin_ + target);
  curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, method.c_str());
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, list.get());
  curl_easy_setopt(curl, CURLOPT_CERTINFO, 1L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_body);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, take_field);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &answer);
  const CURLcode code = curl_easy_perform(curl);
  if (code != CURLE_OK) return handle_->failed(origin_ + target, code);
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &answer.status);
  answer.certificate_days = days_left(curl);
  return answer;
}

Expected<std::string> Probe::upgrade(const std::string& target,
                                     const std::vector<std::string>& fields) {
  CURL* curl = handle_->curl;
  handle_->prepare(origin_);
  curl_easy_setopt(curl, CURLOPT_CONNECT_ONLY, 1L);
  const CURLcode code = curl_easy_perform(curl);
  if (code != CURLE_OK) return handle_->failed(origin_, code);
  const std::string host = origin_.substr(origin_.find("//") + 2);
  const std::string request =
      fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n{}\r\n\r\n", target,
                  host.substr(0, host.find('/')), fmt::join(fields, "\r\n"));
  std::string head = send_all(curl, request) ? receive_head(curl) : std::string();
  if (head.empty())
    return fail(ErrorCode::kIo, origin_ + target + " does not answer; check the proxy");
  return head;
}

}  // namespace vitrine
