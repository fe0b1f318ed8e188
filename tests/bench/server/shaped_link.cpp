// SPDX-License-Identifier: Apache-2.0
#include "shaped_link.h"
#include "support/product_names.h"

#include <fcntl.h>
#include <sched.h>

#include <cstdlib>
#include <stdexcept>

namespace vitrine::bench {
namespace {

void run(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

void enter(const FileDescriptor& space) {
  if (::setns(space.get(), CLONE_NEWNET) != 0) throw std::runtime_error("cannot change namespace");
}

FileDescriptor here() {
  // Opens the file without O_CLOEXEC, so that tools started later inherit the descriptor.
  return FileDescriptor(::open("/proc/thread-self/ns/net", O_RDONLY));
}

FileDescriptor fresh() {
  if (::unshare(CLONE_NEWNET) != 0)
    throw std::runtime_error("cannot make a network namespace; run as root");
  return here();
}

}  // namespace

// The client's end of the link is the device v0, the server's end is v1.
ShapedLink::ShapedLink(std::chrono::milliseconds round_trip)
    : before_(here()), server_(fresh()), client_(fresh()) {
  if (round_trip.count() == 0) {
    join_at_once();
  } else {
    join_late(round_trip);
  }
  at_client();
  run("ip addr add 10.99.0.2/24 dev v0 && ip link set v0 up && ip link set lo up");
  at_server();
  run("ip addr add " + std::string(kServer) +
      "/24 dev v1 && ip link set v1 up && ip link set lo up");
}

void ShapedLink::join_at_once() {
  run("ip link add v0 type veth peer name v1");
  run("ip link set v1 netns /proc/self/fd/" + std::to_string(server_.get()));
}

void ShapedLink::join_late(std::chrono::milliseconds round_trip) {
  FileDescriptor client = tun_device("v0");
  at_server();
  line_.emplace(std::move(client), tun_device("v1"), round_trip / 2);
}

ShapedLink::~ShapedLink() {
  ::setns(before_.get(), CLONE_NEWNET);
}

void ShapedLink::at_server() const {
  enter(server_);
}
void ShapedLink::at_client() const {
  enter(client_);
}

void ShapedLink::shape(double bytes_per_second) {
  at_server();
  const std::string bits = std::to_string(static_cast<long>(8 * bytes_per_second));
  run(std::string("tc qdisc ") + (is_shaped_ ? "change" : "add") + " dev v1 root tbf rate " + bits +
      "bit burst 8kb latency 300ms");
  is_shaped_ = true;
  at_client();
}

}  // namespace vitrine::bench
