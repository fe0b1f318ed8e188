// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/audit_trail.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace vitrine::server::cli {
namespace {

std::string user_name() {
  const passwd* const user = ::getpwuid(::getuid());
  return user != nullptr ? user->pw_name : std::to_string(::getuid());
}

// Returns the ID of the user who logged in, which runuser and sudo do not change.
std::string login() {
  constexpr const char* kNobody = "4294967295";
  std::string number;
  std::ifstream("/proc/self/loginuid") >> number;
  return number.empty() || number == kNobody ? "-" : number;
}

// If root has created the file, gives it to the folder's owner, who must be able to append to it
// later.
bool give_to_owner(int file, const std::filesystem::path& folder) {
  struct stat owner {};
  if (::geteuid() != 0) return true;
  return ::stat(folder.c_str(), &owner) == 0 && ::fchown(file, owner.st_uid, owner.st_gid) == 0;
}

}  // namespace

Expected<AuditTrail> AuditTrail::open(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kFile;
  const auto refused = [&](std::string_view why) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot record the change in {}: {}; run the command as the daemon's "
                            "user, or give that user the file",
                            file.string(), why));
  };
  // Uses O_NOFOLLOW, because the folder's owner could replace the file by a symbolic link to a file
  // of root.
  const int opened =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0640);
  if (opened < 0) return refused(std::strerror(errno));
  Log log = Log::to_file(opened);
  if (!give_to_owner(opened, folder)) return refused(std::strerror(errno));
  return AuditTrail(std::move(log));
}

void AuditTrail::record(std::string_view action, std::string_view target, bool is_done) const {
  log_.audit(CommandRecord{.user = user_name(),
                           .login = login(),
                           .action = action,
                           .target = target,
                           .is_done = is_done});
}

}  // namespace vitrine::server::cli
