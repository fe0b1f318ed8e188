// SPDX-License-Identifier: Apache-2.0
#include "cores.h"
#include "support/product_names.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace vitrine::bench {

OnCore::OnCore(int core) {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  if (::sched_getaffinity(0, sizeof before_, &before_) != 0 ||
      ::sched_setaffinity(0, sizeof one, &one) != 0) {
    throw std::runtime_error("two processor cores are needed, one for each side");
  }
}

OnCore::~OnCore() {
  ::sched_setaffinity(0, sizeof before_, &before_);
}

double processor_seconds(pid_t process) {
  double seconds = 0;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    double nanoseconds = 0;
    std::ifstream(task.path() / "schedstat") >> nanoseconds;
    seconds += nanoseconds * 1e-9;
    std::ifstream children(task.path() / "children");
    for (pid_t child; children >> child;)
      seconds += processor_seconds(child);
  }
  return seconds;
}

}  // namespace vitrine::bench
