// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/rig_link.h"

#include <fmt/core.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>
#include <sstream>

namespace vitrine::acquisition {
namespace {

// Milliseconds to wait for an answer. It is long, because the rig may be rendering a picture.
constexpr int kAnswerTimeout = 30'000;
constexpr std::size_t kMaxLine = 1'000;

Unexpected lost(const char* what) {
  return fail(ErrorCode::kIo,
              fmt::format("the simulated rig {}; run the command under vitrine-rig", what));
}

}  // namespace

Expected<RigLink> RigLink::connect(const std::filesystem::path& socket) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = socket.string();
  if (name.size() >= sizeof address.sun_path)
    return fail(
        ErrorCode::kBadInput,
        fmt::format("the path of socket {} is too long; choose a folder with a shorter path",
                    name));
  name.copy(address.sun_path, name.size());
  FileDescriptor fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!fd || ::connect(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    return fail(ErrorCode::kIo, fmt::format("no simulated rig listens at {}: {}; run the command "
                                            "under vitrine-rig",
                                            name, std::strerror(errno)));
  }
  return RigLink(std::move(fd));
}

Expected<int> RigLink::poses() {
  const auto answer = ask("poses");
  if (!answer) return tl::unexpected(answer.error());
  std::istringstream in(*answer);
  int held = 0, on_table = 0;
  if (in >> held >> on_table && held >= 0 && on_table >= 0) return held + on_table;
  return lost("does not say how many poses it has");
}

Expected<void> RigLink::place_target(int pose) {
  return ask(fmt::format("target {}", pose)).map([](const std::string&) {});
}

Expected<void> RigLink::place_object() {
  return ask("object").map([](const std::string&) {});
}

Expected<std::string> RigLink::ask(std::string_view command) {
  const std::string line = fmt::format("{}\n", command);
  if (::send(socket_.get(), line.data(), line.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(line.size()))
    return lost("has closed the connection");
  auto answer = read_line();
  if (!answer) return answer;
  if (answer->starts_with("error: ")) return fail(ErrorCode::kBadInput, answer->substr(7));
  if (answer->starts_with("ok")) answer->erase(0, answer->starts_with("ok ") ? 3 : 2);
  return answer;
}

Expected<std::string> RigLink::read_line() {
  for (;;) {
    if (const auto end = unread_.find('\n'); end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    pollfd readable{.fd = socket_.get(), .events = POLLIN, .revents = 0};
    if (unread_.size() > kMaxLine || ::poll(&readable, 1, kAnswerTimeout) <= 0)
      return lost("does not answer");
    char block[256];
    const ssize_t n = ::recv(socket_.get(), block, sizeof block, 0);
    if (n <= 0) return lost("has closed the connection");
    unread_.append(block, static_cast<std::size_t>(n));
  }
}

}  // namespace vitrine::acquisition
