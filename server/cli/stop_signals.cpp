// SPDX-License-Identifier: Apache-2.0
#include "server/cli/stop_signals.h"

#include <csignal>

namespace vitrine::cli {
namespace {

volatile std::sig_atomic_t g_arrived = 0;

void note(int signal) {
  g_arrived = 1;
  std::signal(signal, SIG_DFL);
}

// Without SA_RESTART: a read from the terminal ends, too.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  g_arrived = 0;
  handle(SIGINT, note);
  handle(SIGTERM, note);
}

StopSignals::~StopSignals() {
  handle(SIGINT, SIG_DFL);
  handle(SIGTERM, SIG_DFL);
}

bool StopSignals::arrived() {
  return g_arrived != 0;
}

}  // namespace vitrine::cli
