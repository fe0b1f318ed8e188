// SPDX-License-Identifier: Apache-2.0
#include "server/transport/live_tls.h"

#include <utility>

namespace vitrine::server {

Expected<std::shared_ptr<LiveTls>> LiveTls::open(const TlsFiles& files) {
  std::shared_ptr<LiveTls> live(new LiveTls(files));
  auto context = TlsContext::load(files);
  if (!context) return tl::unexpected(context.error());
  live->context_ = std::move(*context);
  return live;
}

LiveTls::Times LiveTls::times() const {
  std::error_code ignored;  // a file may be missing while it is being replaced
  return {std::filesystem::last_write_time(files_.certificate, ignored),
          std::filesystem::last_write_time(files_.key, ignored)};
}

std::shared_ptr<const TlsContext> LiveTls::current() const {
  const std::scoped_lock lock(mutex_);
  return context_;
}

Expected<bool> LiveTls::refresh() {
  const Times now = times();
  {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(read_, now) == now) return false;
  }
  auto fresh = TlsContext::load(files_);
  if (!fresh) return tl::unexpected(fresh.error());
  const std::scoped_lock lock(mutex_);
  context_.swap(*fresh);
  return true;
}

}  // namespace vitrine::server
