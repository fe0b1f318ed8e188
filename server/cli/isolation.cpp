// SPDX-License-Identifier: Apache-2.0
#include "server/cli/isolation.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "server/cli/console.h"

namespace vitrine::cli {
namespace {

using Bytes = std::vector<std::uint8_t>;

// People wait for their own commands and may stop them: what the machine has is the limit.
SandboxLimits limits() {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  SandboxLimits limits;
  limits.memory_bytes = std::max(limits.memory_bytes, pages * page);
  limits.answer_bytes = limits.memory_bytes;
  limits.cpu_seconds = 24 * 3600;
  limits.wall = std::chrono::hours(24);
  return limits;
}

// The report's length, the report, the file.
Bytes pack(const Product& product) {
  const std::string report =
      product.report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::uint64_t length = report.size();
  Bytes bytes(sizeof length);
  std::memcpy(bytes.data(), &length, sizeof length);
  bytes.insert(bytes.end(), report.begin(), report.end());
  bytes.insert(bytes.end(), product.file.begin(), product.file.end());
  return bytes;
}

tl::expected<Product, Fault> unpack(const Bytes& bytes) {
  std::uint64_t length = 0;
  if (bytes.size() < sizeof length) return failed("the isolated process gave no answer");
  std::memcpy(&length, bytes.data(), sizeof length);
  if (length > bytes.size() - sizeof length) return failed("the isolated process gave no answer");
  const auto report = bytes.begin() + sizeof length;
  const auto file = report + static_cast<std::ptrdiff_t>(length);
  Product product{nlohmann::json::parse(report, file, nullptr, false), {file, bytes.end()}};
  if (!product.report.is_object()) return failed("the isolated process gave no answer");
  return product;
}

}  // namespace

tl::expected<Product, Fault> isolate(
    const std::string& subject,
    const std::function<Expected<Product>(const ProgressReport&)>& task) {
  ProgressBar bar;
  const auto answer = run_sandboxed(
      limits(),
      [&](const ProgressReport& progress) -> Expected<Bytes> {
        const auto product = task(progress);
        if (!product) return tl::unexpected(product.error());
        return pack(*product);
      },
      bar.report());
  if (!answer) return failed(fmt::format("{}: {}", subject, answer.error().message));
  return unpack(*answer);
}

}  // namespace vitrine::cli
