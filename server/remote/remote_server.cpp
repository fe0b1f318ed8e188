// SPDX-License-Identifier: Apache-2.0
#include "server/remote/remote_server.h"

#include <curl/curl.h>
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <mutex>

namespace vitrine::server {
namespace {

// A running request with its answer, for libcurl's callbacks.
struct HttpTransfer {
  CURL* curl;
  const RemoteRequest& request;
  RemoteAnswer& answer;
  std::size_t sent = 0;
};

bool is_success(CURL* curl) {
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  return status / 100 == 2;
}

std::size_t take_body(char* bytes, std::size_t size, std::size_t count, void* to) {
  const auto& transfer = *static_cast<HttpTransfer*>(to);
  const auto* const first = reinterpret_cast<const std::uint8_t*>(bytes);
  if (transfer.request.take && is_success(transfer.curl))
    return transfer.request.take({first, size * count}) ? size * count : 0;
  auto& body = transfer.answer.body;
  const std::size_t fits = std::min(size * count, RemoteAnswer::kMost - body.size());
  body.append(bytes, fits);
  return size * count;
}

std::size_t take_field(char* bytes, std::size_t size, std::size_t count, void* to) {
  const std::string_view line(bytes, size * count);
  auto& fields = static_cast<HttpTransfer*>(to)->answer.fields;
  if (line.starts_with("HTTP/")) fields.clear();  // drops the fields of an interim (1xx) response
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
  auto& transfer = *static_cast<HttpTransfer*>(from);
  const auto left = transfer.request.body.subspan(transfer.sent);
  const std::size_t fits = std::min(size * count, left.size());
  std::memcpy(bytes, left.data(), fits);
  transfer.sent += fits;
  if (transfer.request.on_sent) transfer.request.on_sent(transfer.sent);
  return fits;
}

int rewind_body(void* from, curl_off_t offset, int origin) {
  if (origin != SEEK_SET) return CURL_SEEKFUNC_CANTSEEK;
  static_cast<HttpTransfer*>(from)->sent = static_cast<std::size_t>(offset);
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

void set_body(CURL* curl, HttpTransfer& transfer) {
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

void sign(CURL* curl, const RemoteSigner& signer) {
  const std::string what = fmt::format("aws:amz:{}:s3", signer.region);
  curl_easy_setopt(curl, CURLOPT_AWS_SIGV4, what.c_str());
  curl_easy_setopt(curl, CURLOPT_USERNAME, signer.access_key.c_str());
  curl_easy_setopt(curl, CURLOPT_PASSWORD, signer.secret_key.c_str());
}

// Returns the days until the server's own certificate, the first in the chain, expires. Parses
// libcurl's text, such as "Expire date:Feb  3 12:00:00 2027 GMT".
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

bool wait_for(CURL* curl, short events, std::chrono::seconds timeout) {
  curl_socket_t socket = CURL_SOCKET_BAD;
  curl_easy_getinfo(curl, CURLINFO_ACTIVESOCKET, &socket);
  pollfd waiting{socket, events, 0};
  return ::poll(&waiting, 1, static_cast<int>(std::chrono::milliseconds(timeout).count())) == 1;
}

bool send_all(CURL* curl, std::string_view text, std::chrono::seconds timeout) {
  while (!text.empty()) {
    std::size_t sent = 0;
    const CURLcode code = curl_easy_send(curl, text.data(), text.size(), &sent);
    if (code == CURLE_AGAIN && wait_for(curl, POLLOUT, timeout)) continue;
    if (code != CURLE_OK) return false;
    text.remove_prefix(sent);
  }
  return true;
}

// Reads the head of the answer up to the empty line. Returns an empty text if the empty line does
// not arrive.
std::string receive_head(CURL* curl, std::chrono::seconds timeout) {
  constexpr std::size_t kLongest = 64 * 1024;
  std::string text;
  while (text.find("\r\n\r\n") == std::string::npos && text.size() < kLongest) {
    char bytes[4096];
    std::size_t taken = 0;
    const CURLcode code = curl_easy_recv(curl, bytes, sizeof bytes, &taken);
    if (code == CURLE_AGAIN && wait_for(curl, POLLIN, timeout)) continue;
    if (code != CURLE_OK || taken == 0) return {};
    text.append(bytes, taken);
  }
  return text;
}

void set_timeouts(CURL* curl, const RemoteRequest& request) {
  const auto timeout = static_cast<long>(request.timeout.count());
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT,
                   static_cast<long>(request.to_connect.value_or(request.timeout).count()));
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, timeout);
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
  char fault[CURL_ERROR_SIZE] = "";
  ~Handle() { curl_easy_cleanup(curl); }

  // Resets the options for a new request, and keeps the connection open.
  void prepare(const RemoteRequest& request) {
    *fault = '\0';
    curl_easy_reset(curl);
    set_timeouts(curl, request);
    curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, fault);
    curl_easy_setopt(curl, CURLOPT_CERTINFO, 1L);
    if (request.bypasses_proxy) curl_easy_setopt(curl, CURLOPT_PROXY, "");
    if (const char* const trusted = std::getenv("SSL_CERT_FILE"))
      curl_easy_setopt(curl, CURLOPT_CAINFO, trusted);
  }
  Unexpected failed(const RemoteRequest& request, CURLcode code) const {
    return fail(
        ErrorCode::kIo,
        fmt::format("cannot reach {}: {}; check the address and the network",
                    origin_of(request.url), *fault != '\0' ? fault : curl_easy_strerror(code)));
  }
};

RemoteServer::RemoteServer() {
  initialise();
  handle_ = std::make_unique<Handle>();
}

RemoteServer::~RemoteServer() = default;

Expected<RemoteAnswer> RemoteServer::ask(const RemoteRequest& request) {
  CURL* curl = handle_->curl;
  if (curl == nullptr) return fail(ErrorCode::kIo, "out of memory; try again");
  handle_->prepare(request);
  RemoteAnswer answer;
  HttpTransfer transfer{curl, request, answer};
  std::vector<std::string> lines = request.fields;
  // Removes libcurl's own field "Expect", but only from unsigned requests: in a signed request,
  // libcurl would include the empty field in the signature but not send it.
  if (request.signer == nullptr) lines.emplace_back("Expect:");
  const List fields = list_of(lines);
  set_body(curl, transfer);
  if (request.signer != nullptr) sign(curl, *request.signer);
  curl_easy_setopt(curl, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request.method.c_str());
  if (request.method == "HEAD") curl_easy_setopt(curl, CURLOPT_NOBODY, 1L);
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, fields.get());
  curl_easy_setopt(curl, CURLOPT_USERAGENT, "vitrine");
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_body);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_HEADERFUNCTION, take_field);
  curl_easy_setopt(curl, CURLOPT_HEADERDATA, &transfer);
  const CURLcode code = curl_easy_perform(curl);
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &answer.status);
  answer.certificate_days = days_left(curl);
  // The server may send an error response before it has received the whole body.
  if (code == CURLE_OK || (code == CURLE_SEND_ERROR && answer.status >= 400)) return answer;
  return handle_->failed(request, code);
}

Expected<std::string> RemoteServer::upgrade(const RemoteRequest& request) {
  CURL* curl = handle_->curl;
  if (curl == nullptr) return fail(ErrorCode::kIo, "out of memory; try again");
  handle_->prepare(request);
  const std::string origin = origin_of(request.url);
  curl_easy_setopt(curl, CURLOPT_URL, origin.c_str());
  curl_easy_setopt(curl, CURLOPT_CONNECT_ONLY, 1L);
  curl_easy_setopt(curl, CURLOPT_HTTP_VERSION, CURL_HTTP_VERSION_1_1);  // HTTP/2 has no upgrades
  const CURLcode code = curl_easy_perform(curl);
  if (code != CURLE_OK) return handle_->failed(request, code);
  const std::string text = fmt::format(
      "{} {} HTTP/1.1\r\nHost: {}\r\n{}\r\n\r\n", request.method, request.url.substr(origin.size()),
      origin.substr(origin.find("//") + 2), fmt::join(request.fields, "\r\n"));
  std::string head;
  if (send_all(curl, text, request.timeout)) head = receive_head(curl, request.timeout);
  if (!head.empty()) return head;
  return fail(ErrorCode::kIo, request.url + " does not respond; check the proxy");
}

std::string origin_of(std::string_view url) {
  const bool is_web = url.starts_with("http://") || url.starts_with("https://");
  if (!is_web) return {};
  const std::size_t host = url.find("//") + 2;
  const std::string_view origin =
      url.substr(0, std::min(url.find_first_of("/?#", host), url.size()));
  return origin.size() > host ? std::string(origin) : std::string();
}

}  // namespace vitrine::server
