// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/operator_socket.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstring>
#include <thread>

#include "acquisition/rig_optics/target.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr std::size_t kLongestCommand = 100;

std::string place_target(std::string_view number, Stage& stage) {
  int pose = -1;
  const auto [end, error] = std::from_chars(number.begin(), number.end(), pose);
  constexpr int kPoses = kHeldPoses + kTablePoses;
  if (error != std::errc() || end != number.end() || pose < 0 || pose >= kPoses)
    return fmt::format("error: no pose {}; give 0 to {}", number, kPoses - 1);
  stage.place_target(pose);
  return "ok";
}

std::string look_at(const Setting& now) {
  const auto word = [](bool on) { return on ? "on" : "off"; };
  return fmt::format("ok {} {} {:.3f}", word(now.is_laser_on), word(now.is_motor_on), now.degrees);
}

class ListeningSocket final : public OperatorSocket {
 public:
  ListeningSocket(FileDescriptor listener, FileDescriptor closing, std::filesystem::path path,
                  Stage& stage)
      : listener_(std::move(listener)),
        closing_(std::move(closing)),
        path_(std::move(path)),
        stage_(stage),
        thread_([this] { serve(); }) {}

  ~ListeningSocket() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(closing_.get(), &one, sizeof one);
    thread_.join();
    ::unlink(path_.c_str());
  }

 private:
  // Waits until `fd` is readable. Returns false when this object is destroyed.
  bool wait_for(int fd) const {
    pollfd waiting[] = {{fd, POLLIN, 0}, {closing_.get(), POLLIN, 0}};
    while (::poll(waiting, 2, -1) < 0 && errno == EINTR) {
    }
    return waiting[1].revents == 0;
  }

  void serve() {
    while (wait_for(listener_.get())) {
      const FileDescriptor caller(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (caller.get() >= 0) converse(caller.get());
    }
  }

  void converse(int caller) {
    std::string heard;
    while (wait_for(caller)) {
      char buffer[256];
      const ssize_t count = ::recv(caller, buffer, sizeof buffer, 0);
      if (count <= 0) return;
      heard.append(buffer, static_cast<std::size_t>(count));
      for (std::size_t end; (end = heard.find('\n')) != std::string::npos;
           heard.erase(0, end + 1)) {
        const std::string answer = obey(std::string_view(heard).substr(0, end), stage_) + "\n";
        if (::send(caller, answer.data(), answer.size(), MSG_NOSIGNAL) < 0) return;
      }
      if (heard.size() > kLongestCommand) return;
    }
  }

  FileDescriptor listener_, closing_;
  std::filesystem::path path_;
  Stage& stage_;
  std::thread thread_;
};

}  // namespace

std::string obey(std::string_view command, Stage& stage) {
  constexpr std::string_view kTarget = "target ";
  if (command == "poses") return fmt::format("ok {} {}", kHeldPoses, kTablePoses);
  if (command.starts_with(kTarget)) return place_target(command.substr(kTarget.size()), stage);
  if (command == "look") return look_at(stage.now());
  if (command != "object")
    return "error: unknown command; say `target N`, `object`, `poses` or `look`";
  stage.place_object();
  return "ok";
}

Expected<std::unique_ptr<OperatorSocket>> open_operator_socket(const std::filesystem::path& socket,
                                                               Stage& stage) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = socket.string();
  const auto refused = [&](const char* why) {
    return fail(ErrorCode::kIo, fmt::format("socket {}: {}; set TMPDIR to a writable folder with a "
                                            "short name",
                                            name, why));
  };
  if (name.size() >= sizeof address.sun_path) return refused("its path is too long");
  std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
  FileDescriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  FileDescriptor closing(::eventfd(0, EFD_CLOEXEC));
  if (closing.get() < 0 ||
      ::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) < 0 ||
      ::listen(listener.get(), 4) < 0) {
    return refused(std::strerror(errno));
  }
  return std::make_unique<ListeningSocket>(std::move(listener), std::move(closing), socket, stage);
}

}  // namespace vitrine::acquisition::rig
