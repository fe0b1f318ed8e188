// SPDX-License-Identifier: Apache-2.0
#include "server/remote/remote_server.h"

#include <curl/curl.h>
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <mutex>

namespace vitrine {
namespace {

// Of one request, as the library's callbacks see it.
struct Transfer {
  const RemoteRequest& request;
  RemoteAnswer& answer;
  std::size_t sent = 0;
};

std::size_t take_body(char* bytes, std::size_t size, std::size_t count, void* to) {
  auto& body = static_cast<Transfer*>(to)->answer.body;
  const std::size_t fits = std::min(size * count, RemoteAnswer::kMost - body.size());
  body.append(bytes, fits);
  return size * count;
}

std::size_t take_field(char* bytes, std::size_t size, std::size_t count, void* to) {
  const std::string_view line(bytes, size * count);
  auto& fields = static_cast<Transfer*>(to)->answer.fields;
  if (line.starts_with("HTTP/")) fields.clear();  // after a 100
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return line.size();
  std::string name(line.substr(0, colon));
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  std::string_view value = line.substr(colon + 1);
  while (!value.empty() && value.front() == ' ')
    value.remove_prefix(1);
  while (!value.empty() && (value.back() == '\r' || value.back() == '\n'))
    value.remove_suffix(1);
  fields[name] = value;
  return line.size();
}

std::size_t give_body(char* bytes, std::size_t size, std::size_t count, void* from) {
  auto& transfer = *static_cast<Transfer*>(from);
  const auto left = transfer.request.body.subspan(transfer.sent);
  const std::size_t fits = std::min(size * count, left.size());
  std::memcpy(bytes, left.data(), fits);
  transfer.sent += fits;
  if (transfer.request.on_sent) transfer.request.on_sent(transfer.sent);
  return fits;
}

int rewind_body(void* from, curl_off_t offset, int origin) {
  if (origin != SEEK_SET) return CURL_SEEKFUNC_CANTSEEK;
  static_cast<Transfer*>(from)->sent = static_cast<std::size_t>(offset);
  return CURL_SEEKFUNC_OK;
}

int is_given_up(void* from, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<const RemoteRequest*>(from)->given_up() ? 1 : 0;
}

void initialise() {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
}

struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using List = std::unique_ptr<curl_slist, FreeList>;

List list_of(const std::vector<std::string>& lines) {
  List list;
  for (const std::string& line : lines) {
    curl_slist* longer = curl_slist_append(list.get(), line.c_str());
    if (longer == nullptr) throw std::bad_alloc();
    static_cast<void>(list.release());
    list.reset(longer);
  }
  return list;
}

void set_body(CURL* curl, Transfer& transfer) {
  if (transfer.request.body.data() == nullptr) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, 0L);
    return;
  }
  curl_easy_setopt(curl, CURLOPT_UPLOAD, 1L);
  curl_easy_setopt(curl, CURLOPT_READFUNCTION, give_body);
  curl_easy_setopt(curl, CURLOPT_READDATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_SEEKFUNCTION, rewind_body);
  curl_easy_setopt(curl, CURLOPT_SEEKDATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_INFILESIZE_LARGE,
                   static_cast<curl_off_t>(transfer.request.body.size()));
}

void set_patience(CURL* curl, const RemoteRequest& request) {
  const auto patience = static_cast<long>(request.patience.count());
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, patience);
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, patience);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT, static_cast<long>(request.deadline.count()));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  if (!request.given_up) return;
  curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, is_given_up);
  curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &request);
  curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
}

}  // namespace

struct RemoteServer::Handle {
  CURL* curl = curl_easy_init();
  ~Handle() { curl_easy_cleanup(curl); }
};

RemoteServer::RemoteServer() {
  initialise();
  handle_ = std::make_unique<Handle>();
}

RemoteServer::~RemoteServer() = default;

Expected<RemoteAnswer> RemoteServer::ask(const RemoteRequest& request) {
  CURL* curl = handle_->curl;
  if (curl == nullptr) return fail(ErrorCode::kIo, "out of memory; try again");
  curl_easy_reset(curl);  // the connection stays
  RemoteAnswer answer;
  Transfer transfer{request, answer};
  char fault[CURL_ERROR_SIZE] = "";
  std::vector<std::string> lines = request.fields;
  lines.emplace_back("Expect:");  // what is sent is wanted
  const List fields = list_of(lines);
  set_body(curl, transfer);
  set_patience(curl, request);
  curl_easy_setopt(curl, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request.method.c_str());
  if (request.method == "HEAD") curl_easy_setopt(curl, CURLOPT_NOBODY, 1L);
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, fields.get());
  curl_easy_setopt(curl, CURLOPT_USERAGENT, "vitrine");
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_body);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, take_field);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, fault);
  const CURLcode code = curl_easy_perform(curl);
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &answer.status);
  // An answer that comes before the body has gone is one all the same.
  if (code == CURLE_OK || (code == CURLE_SEND_ERROR && answer.status >= 400)) return answer;
  return fail(ErrorCode::kIo, fmt::format("cannot reach {}: {}; check the address and the network",
                                          origin_of(request.url),
                                          *fault != '\0' ? fault : curl_easy_strerror(code)));
}

std::string origin_of(std::string_view url) {
  const bool is_web = url.starts_with("http://") || url.starts_with("https://");
  if (!is_web) return {};
  const std::size_t host = url.find("//") + 2;
  const std::string_view origin =
      url.substr(0, std::min(url.find_first_of("/?#", host), url.size()));
  return origin.size() > host ? std::string(origin) : std::string();
}

}  // namespace vitrine
