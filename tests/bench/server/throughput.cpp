// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "cores.h"
#include "load.h"
#include "medians.h"
#include "sections.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/process/nginx.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::bench {
namespace {

constexpr std::size_t kModels = 64, kChunkBytes = 16 * 1024;

// Publishes models of one chunk each, and stores the same chunks as files for nginx.
class Gallery {
 public:
  Gallery() {
    for (std::size_t i = 0; i < kModels; ++i) {
      std::string chunk(kChunkBytes, '\0');
      for (std::size_t at = 0; at < chunk.size(); ++at)
        chunk[at] = static_cast<char>(at * (2 * i + 1) >> 3);
      const test::TinyPmesh pmesh = test::tiny_pmesh("base " + std::to_string(i), chunk);
      chunks_.push_back("/api/v1/chunks/" + to_hex(pmesh.manifest.chunks[0].sha256));
      models_.push_back("/api/v1/models/" + folder_.publish("a model", pmesh));
      manifests_.push_back(models_.back() + "/manifest");
      write(chunks_.back(), chunk);
    }
  }

  const std::filesystem::path& data() const { return folder_.path(); }
  const std::filesystem::path& files() const { return files_.path(); }
  const std::vector<std::string>& chunks() const { return chunks_; }
  const std::vector<std::string>& manifests() const { return manifests_; }

  // Makes the models drafts, so that their chunks need a token. Returns the chunks' request
  // targets.
  std::vector<std::string> close_to_public(std::uint16_t port, const std::string& bearer) const {
    std::vector<std::string> chunks;
    for (std::size_t i = 0; i < kModels; ++i) {
      const std::string body = test::http_get(port, chunks_[i]).body;
      if (test::http_get(port, models_[i] + "/unpublish", bearer, "POST").status >= 300)
        throw std::runtime_error("a model stays public");
      chunks.push_back(models_[i] + chunks_[i].substr(chunks_[i].find("/chunks/")));
      write(chunks.back(), body);
    }
    return chunks;
  }
  std::string bearer() {
    return "Authorization: Bearer " + folder_.token(Role::kOperator) + "\r\n";
  }

  void write(const std::string& target, const std::string& bytes) const {
    const std::filesystem::path file = files_.path().string() + target;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
  }

 private:
  test::ServedFolder folder_;
  test::TemporaryFolder files_;
  std::vector<std::string> models_, chunks_, manifests_;
};

// Returns a configuration of nginx for static files, with caching headers and a log line for each
// request.
std::string nginx_server(const std::filesystem::path& root) {
  return "root " + root.string() +
         ";\ndefault_type application/octet-stream;\n"
         "location /api/v1/chunks/ { add_header Cache-Control \"public, max-age=31536000, "
         "immutable\"; add_header Access-Control-Allow-Origin *; }\n"
         "location /api/v1/models/ { add_header Cache-Control no-cache; "
         "add_header Access-Control-Allow-Origin *; }\n";
}
constexpr const char* kNginxHttp =
    "sendfile on; tcp_nopush on; tcp_nodelay on; keepalive_requests 1000000000;\n"
    "log_format full '$time_iso8601 $request_id $remote_addr \"$request\" $status "
    "$body_bytes_sent $request_time';\naccess_log access.log full;\n";

struct Peer {
  std::uint16_t port;
  pid_t process;
};

// The measured values of one of the two servers in one run.
struct Run {
  Delivery delivery;
  double processor = 0;  // processor seconds per response
};

Run measure(const Peer& peer, Load load) {
  load.port = peer.port;
  const double before = processor_seconds(peer.process);
  Run run{deliver(load)};
  run.processor =
      (processor_seconds(peer.process) - before) / static_cast<double>(run.delivery.answers);
  return run;
}

// Runs both servers alternately. Each result is the median, over all pairs of runs, of the ratio
// of the two servers' values.
class Comparison {
 public:
  Comparison(const Peer& ours, const Peer& nginx, const Effort& effort)
      : ours_(ours), nginx_(nginx), effort_(effort) {}

  // Sends `load` to the daemon and `theirs` to nginx, alternately, five times each.
  void run(const Load& load, const Load& theirs) {
    const OnCore client(kClientCore);
    pairs_.clear();
    for (int i = 0; i < 5; ++i)
      pairs_.emplace_back(measure(ours_, timed(load)), measure(nginx_, timed(theirs)));
  }

  using Value = std::function<double(const Run&)>;
  Figure figure(std::string what, const Value& value, double threshold, bool is_minimum) const {
    std::vector<double> ours, nginx, ratios;
    for (const auto& [a, b] : pairs_) {
      ours.push_back(value(a));
      nginx.push_back(value(b));
      ratios.push_back(value(a) / value(b));
    }
    return {std::move(what), "ratio_to_nginx", median(ours), median(nginx),
            median(ratios),  threshold,        is_minimum};
  }

 private:
  Load timed(Load load) const {
    load.time = std::chrono::milliseconds(effort_.is_quick ? 500 : 3000);
    return load;
  }

  const Peer ours_, nginx_;
  const Effort effort_;
  std::vector<std::pair<Run, Run>> pairs_;
};

double rate(const Run& run) {
  return run.delivery.requests_per_second;
}
double p99(const Run& run) {
  return run.delivery.p99;
}
double processor(const Run& run) {
  return run.processor;
}

std::string request(const std::string& target, const std::string& fields = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

// Returns a header field If-None-Match with the entity tag of the peer's response. Throws unless
// the response has status 200, the body `body` and an entity tag.
std::string checked_etag(const Peer& peer, const std::string& target, const std::string& body) {
  const test::HttpAnswer answer = test::http_get(peer.port, target);
  if (answer.status != 200 || answer.body != body || answer.field("etag").empty())
    throw std::runtime_error("not served as it should be: " + target);
  return "If-None-Match: " + answer.field("etag") + "\r\n";
}

}  // namespace

void throughput(Report& report, const Effort& effort) {
  Gallery gallery;
  Load chunks{.status = 200}, private_chunks{.status = 200}, our_manifests{.status = 304},
      their_manifests{.status = 304};
  const test::Daemon daemon = [&] {
    const OnCore server(kServerCore);
    return test::Daemon(gallery.data(), {"--threads", "1", "--request-rate", "1000000"});
  }();
  const test::Nginx nginx = [&] {
    const OnCore server(kServerCore);
    return test::Nginx(nginx_server(gallery.files()), kNginxHttp);
  }();
  const Peer ours{daemon.port(), daemon.pid()}, theirs{nginx.port(), nginx.pid()};
  for (std::size_t i = 0; i < kModels; ++i) {
    const std::string& chunk = gallery.chunks()[i];
    checked_etag(theirs, chunk, test::http_get(ours.port, chunk).body);
    chunks.requests.push_back(request(chunk));
    const std::string& manifest = gallery.manifests()[i];
    const std::string json = test::http_get(ours.port, manifest).body;
    gallery.write(manifest, json);
    our_manifests.requests.push_back(request(manifest, checked_etag(ours, manifest, json)));
    their_manifests.requests.push_back(request(manifest, checked_etag(theirs, manifest, json)));
  }
  Comparison comparison(ours, theirs, effort);
  comparison.run(chunks, chunks);
  report.add(comparison.figure("chunk_get", rate, 1.2, true));
  report.add(comparison.figure("chunk_get_processor", processor, kNoThreshold, false));
  report.add(comparison.figure("p99", p99, 1.5, false));
  comparison.run(our_manifests, their_manifests);
  report.add(comparison.figure("manifest_304", rate, 1.0, true));
  report.add(comparison.figure("manifest_304_processor", processor, kNoThreshold, false));
  report.add(comparison.figure("manifest_304_p99", p99, 1.5, false));
  const std::string bearer = gallery.bearer();
  for (const std::string& chunk : gallery.close_to_public(ours.port, bearer)) {
    if (test::http_get(ours.port, chunk).status != 404)
      throw std::runtime_error("served without a token: " + chunk);
    private_chunks.requests.push_back(request(chunk, bearer));
  }
  comparison.run(private_chunks, private_chunks);
  report.add(comparison.figure("private_chunk_get", rate, 0.95, true));
  report.add(comparison.figure("private_chunk_get_p99", p99, 1.5, false));
}

}  // namespace vitrine::bench
