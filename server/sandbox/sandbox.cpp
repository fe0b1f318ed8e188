// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/sandbox.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <malloc.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <memory>

#include "server/sandbox/child_channel.h"
#include "server/sandbox/separation.h"

namespace vitrine::server {
namespace {

Unexpected refused(const char* what, int error) {
  return fail(ErrorCode::kIo, fmt::format("cannot {}: {}; a Linux kernel with seccomp is needed",
                                          what, std::strerror(error)));
}

// The allowed system calls. They suffice to compute with several threads, to read open files and to
// send a result.
constexpr int kAllowed[] = {SCMP_SYS(read),
                            SCMP_SYS(pread64),
                            SCMP_SYS(write),
                            SCMP_SYS(writev),
                            SCMP_SYS(close),
                            SCMP_SYS(lseek),
                            SCMP_SYS(fstat),
                            SCMP_SYS(brk),
                            SCMP_SYS(munmap),
                            SCMP_SYS(mremap),
                            SCMP_SYS(madvise),
                            SCMP_SYS(futex),
                            SCMP_SYS(rt_sigaction),
                            SCMP_SYS(rt_sigprocmask),
                            SCMP_SYS(rt_sigreturn),
                            SCMP_SYS(sigaltstack),
                            SCMP_SYS(clock_gettime),
                            SCMP_SYS(gettimeofday),
                            SCMP_SYS(getrusage),
                            SCMP_SYS(getpid),
                            SCMP_SYS(gettid),
                            SCMP_SYS(sched_yield),
                            SCMP_SYS(getrandom),
                            SCMP_SYS(sched_getaffinity),
                            SCMP_SYS(exit),
                            SCMP_SYS(exit_group),
                            SCMP_SYS(set_robust_list),
                            SCMP_SYS(rseq),
                            SCMP_SYS(nanosleep),
                            SCMP_SYS(clock_nanosleep),
                            SCMP_SYS(restart_syscall)};

// System calls that fail with the error "permission denied". Libraries try these calls and can
// continue if they fail.
constexpr int kDenied[] = {SCMP_SYS(open),       SCMP_SYS(openat),     SCMP_SYS(openat2),
                           SCMP_SYS(newfstatat), SCMP_SYS(stat),       SCMP_SYS(access),
                           SCMP_SYS(faccessat),  SCMP_SYS(faccessat2), SCMP_SYS(readlink),
                           SCMP_SYS(readlinkat), SCMP_SYS(prlimit64),  SCMP_SYS(ioctl),
                           SCMP_SYS(prctl),      SCMP_SYS(sysinfo),    SCMP_SYS(statx)};

using Filter = std::unique_ptr<void, decltype(&seccomp_release)>;

// Adds rules to a filter and remembers the first error. load() returns that error, or 0 if there is
// none.
class Rules {
 public:
  explicit Rules(const Filter& filter) : filter_(filter.get()) {}

  void allow(int call) { keep(seccomp_rule_add(filter_, SCMP_ACT_ALLOW, call, 0)); }
  void allow_if(int call, const scmp_arg_cmp& condition) {
    keep(seccomp_rule_add_array(filter_, SCMP_ACT_ALLOW, call, 1, &condition));
  }
  void deny(int call, int error) {
    keep(seccomp_rule_add(filter_, SCMP_ACT_ERRNO(static_cast<std::uint32_t>(error)), call, 0));
  }
  int load() {
    if (result_ == 0) result_ = seccomp_load(filter_);
    return -result_;
  }

 private:
  void keep(int result) {
    if (result_ == 0) result_ = result;
  }
  scmp_filter_ctx filter_;
  int result_ = 0;
};

// Returns a condition on an argument of a system call. libseccomp offers only macros for this,
// which work only in C.
scmp_arg_cmp argument(unsigned index, scmp_compare how, scmp_datum_t a, scmp_datum_t b = 0) {
  return {index, how, a, b};
}

Expected<void> install_filter() {
  // A call without a rule ends the process. This includes all calls that deal with sockets,
  // programs, other processes and ptrace.
  const Filter filter(seccomp_init(SCMP_ACT_KILL_PROCESS), seccomp_release);
  if (!filter) return refused("create a system call filter", ENOMEM);
  Rules rules(filter);
  for (const int call : kAllowed)
    rules.allow(call);
  for (const int call : kDenied)
    rules.deny(call, EACCES);
  // Forbids making memory executable, and using clone for anything but threads.
  rules.allow_if(SCMP_SYS(mmap), argument(2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  rules.allow_if(SCMP_SYS(mprotect), argument(2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  rules.allow_if(SCMP_SYS(clone), argument(0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
  // A filter cannot check the flags of clone3, which are in memory. If clone3 fails with ENOSYS,
  // libc uses clone.
  rules.deny(SCMP_SYS(clone3), ENOSYS);
  rules.allow_if(SCMP_SYS(tgkill), argument(0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid())));
  if (const int error = rules.load(); error != 0)
    return refused("install a system call filter", error);
  return {};
}

// The size in bytes from which a freed block is returned to the system at once. By default, glibc
// raises this size while the program runs. Freed memory would then stay fragmented, which increases
// the peak by a seventh.
constexpr int kLargeBlock = 1 << 20;

// Sets a limit. A lower hard limit that the process has inherited stays in force.
int set_limit(int which, rlim_t soft, rlim_t hard) {
  const auto resource = static_cast<__rlimit_resource_t>(which);
  rlimit inherited{};
  if (::getrlimit(resource, &inherited) != 0) return errno;
  const rlimit limit{std::min(soft, inherited.rlim_max), std::min(hard, inherited.rlim_max)};
  return ::setrlimit(resource, &limit) == 0 ? 0 : errno;
}

// The address space cannot be limited under a sanitizer, because sanitizers reserve terabytes of it
// for shadow memory.
#ifdef VITRINE_SANITISED
constexpr bool kLimitMemory = false;
#else
constexpr bool kLimitMemory = true;
#endif

Expected<void> set_limits(const SandboxLimits& limits) {
  int error = 0;
  const auto limit = [&](int which, rlim_t value, rlim_t grace = 0) {
    if (error == 0) error = set_limit(which, value, value + grace);
  };
  if (kLimitMemory) {
    limit(RLIMIT_AS, limits.memory_bytes + spill_capacity());
    // Limits private memory, too. Without this limit, private memory could use the address space of
    // unmapped parts of the spill file.
    limit(RLIMIT_DATA, limits.memory_bytes);
  }
  limit(RLIMIT_CPU, limits.cpu_seconds, 1);  // sends SIGXCPU, and SIGKILL one second later
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NOFILE, 0);  // allows no new descriptor; open files stay open
  if (error != 0) return refused("limit a child process", error);
  return {};
}

// Redirects the standard streams to /dev/null and closes all other descriptors except `kept`.
void close_all_but(int kept) {
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int fd = 0; fd <= 2; ++fd)
    ::dup2(nowhere, fd);
  ::close_range(3, static_cast<unsigned>(kept) - 1, 0);
  ::close_range(static_cast<unsigned>(kept) + 1, ~0u, 0);
}

}  // namespace

Expected<void> confine(const SandboxLimits& limits) {
  ::mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  be_killed_first();
  static_cast<void>(leave_network());
  if (auto limited = set_limits(limits); !limited) return limited;
  if (::prctl(PR_SET_DUMPABLE, 0) != 0 || ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return refused("drop privileges", errno);
  }
  return install_filter();
}

Expected<std::vector<std::uint8_t>> run_sandboxed(const SandboxLimits& limits,
                                                  const SandboxedTask& task,
                                                  const ProgressReport& progress) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return refused("make a pipe", errno);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent may have died before the call of prctl()
    close_all_but(ends[1]);
    answer_and_exit(ends[1], limits, task);
  }
  const int error = errno;
  ::close(ends[1]);
  auto answer = child < 0 ? Expected<std::vector<std::uint8_t>>(refused("start a process", error))
                          : await_answer(child, ends[0], limits, progress);
  ::close(ends[0]);
  return answer;
}

}  // namespace vitrine::server
