// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/rig_link.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <thread>

#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

// A fake rig that answers each line with the next element of `answers`. After the last answer, it
// closes the connection.
class FakeRig {
 public:
  FakeRig(const std::filesystem::path& path, std::vector<std::string> answers)
      : listener_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    ::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address);
    ::listen(listener_.get(), 1);
    thread_ = std::jthread([this, answers = std::move(answers)] { serve(answers); });
  }
  const std::vector<std::string>& heard() {
    thread_.join();
    return heard_;
  }

 private:
  void serve(const std::vector<std::string>& answers) {
    const FileDescriptor caller(::accept(listener_.get(), nullptr, nullptr));
    for (const std::string& answer : answers) {
      std::string line;
      for (char c = 0; ::recv(caller.get(), &c, 1, 0) == 1 && c != '\n';)
        line += c;
      heard_.push_back(line);
      ::send(caller.get(), answer.data(), answer.size(), MSG_NOSIGNAL);
    }
  }

  FileDescriptor listener_;
  std::vector<std::string> heard_;
  std::jthread thread_;
};

TEST(RigLink, AsksForTargetAndObject) {
  const TemporaryFolder folder;
  FakeRig rig(folder.path() / "rig", {"ok 30 1\n", "ok\n", "ok\n"});
  auto link = RigLink::connect(folder.path() / "rig");
  ASSERT_TRUE(link);
  EXPECT_EQ(*link->poses(), 31);
  EXPECT_TRUE(link->place_target(7));
  EXPECT_TRUE(link->place_object());
  EXPECT_THAT(rig.heard(), testing::ElementsAre("poses", "target 7", "object"));
}

TEST(RigLink, ARefusalOrAnEndIsAnError) {
  const TemporaryFolder folder;
  FakeRig rig(folder.path() / "rig", {"error: no pose 99; give 0 to 30\n", "ok what\n", "ok\n"});
  auto link = RigLink::connect(folder.path() / "rig");
  ASSERT_TRUE(link);
  EXPECT_EQ(link->place_target(99).error().message, "no pose 99; give 0 to 30");
  EXPECT_THAT(link->poses().error().message, HasSubstr("how many poses"));
  EXPECT_TRUE(link->place_object());
  EXPECT_THAT(link->place_object().error().message, HasSubstr("has closed the connection"));
}

TEST(RigLink, NobodyThereIsAnErrorThatSaysWhere) {
  EXPECT_THAT(RigLink::connect("/absent/rig").error().message,
              HasSubstr("no simulated rig listens at /absent/rig"));
  EXPECT_THAT(RigLink::connect(std::string(200, 'x')).error().message, HasSubstr("too long"));
}

}  // namespace
}  // namespace vitrine::test
