// SPDX-License-Identifier: Apache-2.0
// Separates a child process from resources that all processes share: the network and the memory of
// the machine. Call these functions in the child, before confine() of sandbox.h forbids them.
#pragma once

namespace vitrine::server {

// Moves the calling process into a user namespace and a network namespace of its own, which has no
// interface except an unused loopback. The process must have one thread. Returns false if the
// kernel or the service manager does not allow this. In that case, only the seccomp filter blocks
// the network.
bool leave_network() noexcept;

// Makes the kernel kill the calling process first if the machine or the control group runs out of
// memory. Has no effect without /proc.
void be_killed_first() noexcept;

}  // namespace vitrine::server
