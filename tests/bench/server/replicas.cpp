// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <stdexcept>

#include "../../server/app/remote_installation.h"
#include "load.h"
#include "medians.h"
#include "sections.h"
#include "server/store/publish.h"
#include "support/descriptor_limit.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/process/nginx.h"
#include "support/product_names.h"
#include "support/resident_memory.h"
#include "support/tiny_pmesh.h"
#include "viewer.h"

namespace vitrine::bench {
namespace {

constexpr std::size_t kScans = 64, kPieceBytes = 16 * 1024, kReplicas = 3;
constexpr const char *kOne = "one",
                     *kThree = "three";  // host names in the clients' requests to nginx

// Runs four daemons on one bucket and one database. One daemon has a host name of its own; the
// other three daemons share another host name.
class Replicas {
 public:
  Replicas() : installation_(open_installation(elsewhere_.place()).value()) {
    for (std::size_t i = 0; i < kScans; ++i)
      publish_one(i);
    for (std::size_t i = 0; i <= kReplicas; ++i)
      daemons_.emplace_back(
          folder_.path() / std::to_string(i),
          std::vector<std::string>{"--config", elsewhere_.file(), "--threads", "1",
                                   "--request-rate", "0", "--max-connections", "13000",
                                   "--max-connections-per-address", "0", "--idle-timeout", "3600"});
  }

  const std::vector<std::string>& models() const { return models_; }
  const std::vector<std::string>& chunks() const { return chunks_; }

  std::string etag(const std::string& target) const {
    return test::http_get(daemons_.front().port(), target).field("etag");
  }

  // Returns the daemons' addresses for the configuration of nginx.
  std::string upstreams() const {
    std::string one, three;
    for (const test::Daemon& daemon : daemons_)
      (&daemon == &daemons_.front() ? one : three) +=
          fmt::format(" server 127.0.0.1:{};", daemon.port());
    return fmt::format(
        "upstream {} {{{} keepalive 512; keepalive_requests 1000000000; }}\nupstream {} {{{} "
        "keepalive 512; keepalive_requests 1000000000; }}\n",
        kOne, one, kThree, three);
  }

  // Returns the resident memory of all daemons behind `host`, in bytes.
  double resident(const std::string& host) const {
    double sum = 0;
    for (const test::Daemon& daemon : daemons_) {
      if ((&daemon == &daemons_.front()) == (host == kOne))
        sum += static_cast<double>(test::resident_bytes(daemon.pid()));
    }
    return sum;
  }

 private:
  void publish_one(std::size_t number) {
    std::string chunk(kPieceBytes, '\0');
    for (std::size_t at = 0; at < chunk.size(); ++at)
      chunk[at] = static_cast<char>(at * (2 * number + 1) >> 3);
    const test::TinyPmesh pmesh = test::tiny_pmesh("base " + std::to_string(number), chunk);
    const auto published =
        publish(*installation_.store, *installation_.catalogue, pmesh.bytes, {.title = "a model"});
    if (!published) throw std::runtime_error(published.error().message);
    models_.push_back(published->id.to_string());
    chunks_.push_back("/api/v1/chunks/" + to_hex(pmesh.manifest.chunks[0].sha256));
  }

  const test::RemoteInstallation elsewhere_;
  const test::TemporaryFolder folder_;
  const Installation installation_;
  std::vector<std::string> models_, chunks_;
  std::list<test::Daemon> daemons_;
};

// Configuration of nginx that forwards every request to the daemons of the requested host, without
// a cache.
constexpr const char* kPassOn =
    "location / { proxy_pass http://$host; proxy_http_version 1.1; proxy_buffering off;\n"
    "proxy_read_timeout 1h; proxy_set_header Upgrade $http_upgrade;\n"
    "proxy_set_header Connection $onward; }\n";
constexpr const char* kConnection =
    "keepalive_requests 1000000000; access_log access.log;\n"
    "map $http_upgrade $onward { \"\" \"\"; default upgrade; }\n";

std::string request(const std::string& target, const std::string& host, const std::string& more) {
  return "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
}

// Measures the requests per second with three daemons, as a multiple of those with one daemon.
class Throughput {
 public:
  Throughput(const Replicas& replicas, std::uint16_t port, const Effort& effort)
      : replicas_(replicas), port_(port), effort_(effort) {}

  Figure chunks() const {
    return compare("replicas_chunk_get", 200, .85, [&](std::size_t i, const std::string& host) {
      return request(replicas_.chunks()[i], host, "");
    });
  }
  Figure manifests() const {
    return compare(
        "replicas_manifest_304", 304, kNoThreshold, [&](std::size_t i, const std::string& host) {
          const std::string target = "/api/v1/models/" + replicas_.models()[i] + "/manifest";
          return request(target, host, "If-None-Match: " + replicas_.etag(target) + "\r\n");
        });
  }

 private:
  template <class Request>
  Figure compare(const std::string& what, int status, double threshold,
                 const Request& request_of) const {
    const auto rate = [&](const std::string& host) {
      Load load{.port = port_, .requests = {}, .status = status, .connections = 256};
      load.time = std::chrono::milliseconds(effort_.is_quick ? 500 : 3000);
      for (std::size_t i = 0; i < kScans; ++i)
        load.requests.push_back(request_of(i, host));
      return deliver(load).requests_per_second;
    };
    rate(kThree);  // fills the caches of each daemon before the measurement
    std::vector<double> ones, threes, ratios;
    for (int run = 0; run < 5; ++run) {
      ones.push_back(rate(kOne));
      threes.push_back(rate(kThree));
      ratios.push_back(threes.back() / ones.back());
    }
    return {what,      "ratio_to_one_replica",   median(threes), median(ones), median(ratios),
            threshold, threshold != kNoThreshold};
  }

  const Replicas& replicas_;
  const std::uint16_t port_;
  const Effort effort_;
};

// Returns the memory, in bytes per viewer, that the daemons behind `host` need for `count` idle
// viewers.
double bytes_per_viewer(const Replicas& replicas, std::uint16_t port, const std::string& host,
                        std::size_t count) {
  std::vector<Viewer> viewers;
  const auto connect = [&](std::size_t more) {
    for (const std::size_t end = viewers.size() + more; viewers.size() < end;) {
      viewers.emplace_back(port, replicas.models()[viewers.size() % kScans], host);
      viewers.back().greet();
    }
  };
  connect(10 * kReplicas);  // the first viewers cause allocations that later viewers share
  const double before = replicas.resident(host);
  connect(count);
  return (replicas.resident(host) - before) / static_cast<double>(count);
}

}  // namespace

void replicas(Report& report, const Effort& effort) {
  test::raise_descriptor_limit();
  const Replicas replicas;
  const test::Nginx nginx(kPassOn, replicas.upstreams() + kConnection);
  const Throughput throughput(replicas, nginx.port(), effort);
  report.add(throughput.chunks());
  report.add(throughput.manifests());
  const std::size_t viewers = effort.is_quick ? 300 : 1'500;
  const double one = bytes_per_viewer(replicas, nginx.port(), kOne, viewers);
  const double three = bytes_per_viewer(replicas, nginx.port(), kThree, viewers);
  report.add({"replicas_viewer", "ratio_to_one_replica", three, one, three / one, kNoThreshold});
  report.add({"replicas_viewer", "ratio_to_20_kb", three, 20'000, three / 20'000, 1});
}

}  // namespace vitrine::bench
