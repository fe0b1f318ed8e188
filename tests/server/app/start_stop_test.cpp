// SPDX-License-Identifier: Apache-2.0
// Tests how the real daemon starts, refuses to start, and ends.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <regex>
#include <sstream>

#include "server/store/file_lock.h"
#include "server/store/installation.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string slurp(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

bool accepts(std::uint16_t port) {
  try {
    const HttpClient client(port);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

TEST(Start, SaysItsVersionAndItsOptions) {
  EXPECT_THAT(run_vitrined({"--version"}).output, HasSubstr("vitrined 0."));
  const ProgramResult help = run_vitrined({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, HasSubstr("--admin-listen HOST:PORT"));
}

TEST(Start, WrongUsageIsOneLineWithASuggestionAndExitCode2) {
  EXPECT_THAT(run_vitrined({"--l\xffsen", "127.0.0.1:0"}).output, HasSubstr("--l\\xffsen"));
  const ProgramResult result = run_vitrined({"--lisen", "127.0.0.1:0"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines(result.output), 1u);
  EXPECT_THAT(result.output, HasSubstr("did you mean '--listen'?"));
}

TEST(Start, ChecksAConfigurationWithoutServing) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "vitrine.conf").string();
  std::ofstream(file) << "listen = 127.0.0.1:0\n";
  EXPECT_EQ(run_vitrined({"--config", file, "--check-config"}).exit_code, 0);
  EXPECT_THAT(run_vitrined({"--config", file, "--print-config"}).output,
              HasSubstr("listen = \"127.0.0.1:0\""));
  std::ofstream(file) << "listne = 127.0.0.1:0\n";
  const ProgramResult result = run_vitrined({"--config", file, "--check-config"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.output, HasSubstr(file + ":1: unknown key 'listne'; did you mean 'listen'?"));
}

TEST(Start, OnlyTheOwnerCanEnterANewDataFolderAndReadItsCatalogue) {
  const TemporaryFolder folder;
  const std::filesystem::path data = folder.path() / "parent" / "data";
  const mode_t mask = ::umask(0);
  const Daemon daemon(data);
  ::umask(mask);
  using std::filesystem::perms;
  const auto mode_of = [](const std::filesystem::path& path) {
    return std::filesystem::status(path).permissions();
  };
  EXPECT_EQ(mode_of(data), perms::owner_all);
  for (const char* suffix : {"", "-wal", "-shm"})
    EXPECT_EQ(mode_of((data / kCatalogueFile).string() + suffix),
              perms::owner_read | perms::owner_write);
}

TEST(Start, WarnsIfOthersCanReadTheDataFolder) {
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  Daemon daemon(folder.path());
  daemon.wait_for_line("run chmod o-rwx " + folder.path().string());
}

TEST(Start, ChecksThePathsOfAConfigurationAndCreatesNothing) {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  std::ofstream(path("file")) << "not a folder";
  const auto check = [](const std::string& flag, const std::string& value) {
    return run_vitrined({flag, value, "--check-config"});
  };
  for (const std::string flag : {"--data", "--port-file", "--admin-port-file", "--access-log"}) {
    const ProgramResult result = check(flag, path("file/below"));
    EXPECT_EQ(result.exit_code, 1) << flag;
    EXPECT_EQ(lines(result.output), 1u);
    EXPECT_THAT(result.output, HasSubstr(flag.substr(2) + ": cannot write " + path("file/below")));
    EXPECT_THAT(result.output, HasSubstr("; a part of the path is a file: choose another folder"));
  }
  EXPECT_EQ(check("--data", path("file")).exit_code, 1);
  EXPECT_EQ(check("--port-file", folder.path().string()).exit_code, 1);
  EXPECT_EQ(check("--data", path("new/folder")).exit_code, 0);
  EXPECT_EQ(check("--data", folder.path().string()).exit_code, 0);
  EXPECT_EQ(check("--access-log", "/dev/null").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("new")));
}

TEST(Start, ChecksTheFilesOfTheScanners) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "rig.json").string();
  const auto check = [&](const std::string& files) {
    return run_vitrined({"--scanners", files, "--check-config"});
  };
  const ProgramResult missing = check(file);
  EXPECT_NE(missing.exit_code, 0);
  EXPECT_THAT(missing.output, HasSubstr(file));
  std::ofstream(file) << R"({"name": "rig", "camera": {"address": "127.0.0.1"},
    "board": {"dialect": "fabscan", "vendor": "0x2341", "product": "0x0043"},
    "exposure_us": 4000, "gain_db": 0, "region": {"x": 0, "y": 0, "width": 1300, "height": 1030},
    "target": {"squares_x": 9, "squares_y": 14, "square_mm": 8, "marker_mm": 6,
               "dictionary": "DICT_4X4_100"},
    "steps": 720, "calibrations": "calibrations"})";
  EXPECT_EQ(check(file).exit_code, 0) << check(file).output;
  const ProgramResult twice = check(file + "," + file);
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.output, HasSubstr("another scanner is named rig"));
}

TEST(Start, RefusesAFolderAsConfigurationAndAnAddressThatIsNoNumber) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_vitrined({"--config", folder.path().string(), "--check-config"}).exit_code, 1);
  const ProgramResult named = run_vitrined({"--listen", "museum.example:80", "--check-config"});
  EXPECT_EQ(named.exit_code, 2);
  EXPECT_THAT(named.output, HasSubstr("'museum.example' is not a numeric address"));
  EXPECT_EQ(run_vitrined({"--listen", "[::1]:80", "--check-config"}).exit_code, 0);
  EXPECT_EQ(run_vitrined({"--data", "", "--check-config"}).exit_code, 2);
}

TEST(Start, APortInUseIsOneLineWithTheNextStepAndExitCode1) {
  const ServedFolder folder;
  const Daemon daemon(folder.path());
  const std::string address = "127.0.0.1:" + std::to_string(daemon.port());
  const ProgramResult result =
      run_vitrined({"--listen", address, "--data", folder.path().string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(lines(result.output), 1u);
  EXPECT_THAT(result.output,
              HasSubstr("cannot listen on " + address + ": Address already in use; "));
}

TEST(Start, AFileThatCannotBeWrittenIsNamedBeforeAPortInUse) {
  const ServedFolder folder;
  const Daemon daemon(folder.path());
  const std::string address = "127.0.0.1:" + std::to_string(daemon.port());
  const std::string data = (folder.path() / "fresh").string();
  const std::string file = (folder.path() / "file").string();
  std::ofstream(file) << "not a folder";
  for (const std::string flag : {"--port-file", "--admin-port-file", "--access-log"}) {
    const ProgramResult result =
        run_vitrined({"--listen", address, "--data", data, flag, file + "/below"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.output, HasSubstr(flag.substr(2) + ": cannot write " + file + "/below"));
    // The daemon creates its data folder itself, so options may name files in a folder that does
    // not exist yet. The start fails only because the address is in use.
    EXPECT_THAT(run_vitrined({"--listen", address, "--data", data, flag, data + "/below"}).output,
                HasSubstr("cannot listen on " + address));
  }
  EXPECT_FALSE(std::filesystem::exists(data));
}

TEST(Start, APortInUseLeavesNoFreshDataFolderBehind) {
  const ServedFolder folder;
  const Daemon daemon(folder.path());
  const std::string address = "127.0.0.1:" + std::to_string(daemon.port());
  const auto fresh = folder.path() / "fresh";
  EXPECT_EQ(run_vitrined({"--listen", address, "--data", fresh.string()}).exit_code, 1);
  EXPECT_EQ(
      run_vitrined({"--listen", "127.0.0.1:0", "--admin-listen", address, "--data", fresh.string()})
          .exit_code,
      1);
  EXPECT_FALSE(std::filesystem::exists(fresh));
}

TEST(Start, AnAdministrationPortInUseIsNamed) {
  const ServedFolder folder;
  const Daemon daemon(folder.path());
  const std::string address = "127.0.0.1:" + std::to_string(daemon.port());
  const ProgramResult result = run_vitrined(
      {"--listen", "127.0.0.1:0", "--admin-listen", address, "--data", folder.path().string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("--admin-listen: cannot listen on " + address));
}

TEST(Start, ADataFolderThatCannotBeUsedIsOneLineAndExitCode1) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "file").string();
  std::ofstream(file) << "not a folder";
  const ProgramResult result = run_vitrined({"--listen", "127.0.0.1:0", "--data", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(lines(result.output), 1u);
  EXPECT_THAT(result.output, HasSubstr(file));
}

TEST(Start, ADataFolderIsOfOneDaemonAndFreeOnceItIsDead) {
  const ServedFolder folder;
  {
    const Daemon daemon(folder.path());
    const ProgramResult second = run_vitrined({"--listen", "127.0.0.1:0", "--admin-listen",
                                               "127.0.0.1:0", "--data", folder.path().string()});
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_THAT(second.output, HasSubstr("another daemon uses the data folder"));
  }
  const Daemon next(folder.path());
}

TEST(Start, ACopyOfADataFolderIsAnotherDaemons) {
  const ServedFolder folder;
  const TemporaryFolder place;
  const std::filesystem::path copy = place.path() / "copy";
  const auto id_in = [](const std::filesystem::path& data) {
    std::string id;
    std::ifstream(data / kDaemonLock) >> id;
    return id;
  };
  { const Daemon daemon(folder.path()); }
  const std::string id = id_in(folder.path());
  { const Daemon again(folder.path()); }
  EXPECT_EQ(id_in(folder.path()), id);
  std::filesystem::copy(folder.path(), copy, std::filesystem::copy_options::recursive);
  {
    Daemon other(copy);
    other.signal(SIGTERM);
    EXPECT_THAT(other.wait().output, HasSubstr("the data folder is a copy"));
  }
  const std::string others = id_in(copy);
  EXPECT_NE(others, id);
  { const Daemon again(copy); }
  EXPECT_EQ(id_in(copy), others);
}

TEST(Start, TheCatalogueOfAnotherDaemonIsNotTouched) {
  const TemporaryFolder folder;
  const FileDescriptor other(
      ::open((folder.path() / kDaemonLock).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  ASSERT_TRUE(lock_file(other.get()));
  EXPECT_EQ(run_vitrined({"--listen", "127.0.0.1:0", "--data", folder.path().string()}).exit_code,
            1);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / kCatalogueFile));
}

TEST(Start, WhoDoesNotServeAnswersTheAdministratorAlone) {
  const ServedFolder folder;
  Daemon daemon(folder.path(), {"--roles", "build"});
  EXPECT_EQ(daemon.port(), 0);
  EXPECT_EQ(http_get(daemon.admin_port(), "/readyz").status, 200);
  EXPECT_EQ(http_get(daemon.admin_port(), "/metrics").status, 200);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

TEST(Start, WritesThePortsToFiles) {
  const ServedFolder folder;
  const auto port_file = folder.path() / "port", admin_file = folder.path() / "admin-port";
  const Daemon daemon(
      folder.path(), {"--port-file", port_file.string(), "--admin-port-file", admin_file.string()});
  EXPECT_EQ(slurp(port_file), std::to_string(daemon.port()) + "\n");
  EXPECT_EQ(slurp(admin_file), std::to_string(daemon.admin_port()) + "\n");
}

TEST(Stop, SigtermEndsIdleConnectionsAndTheDaemonWithACleanLog) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon(folder.path());
  HttpClient idle(daemon.port());
  const HttpAnswer seen = idle.get("/api/v1/models/" + id);
  EXPECT_EQ(seen.status, 200);
  EXPECT_EQ(http_get(daemon.port(), "/nothing\"here").status, 404);
  daemon.signal(SIGTERM);
  EXPECT_TRUE(idle.is_closed());
  const ProgramResult result = daemon.wait();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("message=stopped\n"));
  EXPECT_THAT(result.output, Not(HasSubstr("event=error")));
  const std::regex line(
      R"(time=\S+Z event=access id=[0-9a-f]{16} remote=127\.0\.0\.1 method=GET route=\S+ )"
      R"(target=(\S+|"(\\.|[^"\\])*") status=\d+ bytes=\d+ seconds=\d+\.\d{6})");
  std::istringstream log(daemon.access_log());
  std::size_t count = 0;
  for (std::string text; std::getline(log, text); ++count) {
    EXPECT_TRUE(std::regex_match(text, line)) << text;
  }
  EXPECT_EQ(count, 2u);
  EXPECT_THAT(daemon.access_log(), HasSubstr(" id=" + seen.field("x-request-id") + " "));
}

TEST(Stop, FinishesATransferThatIsUnderWay) {
  // The response is larger than the sockets' buffers, and the client sends more requests than the
  // daemon reads ahead. If the daemon closed a socket with unread requests, this would reset the
  // connection and lose the end of the response.
  std::string chunk;
  chunk.resize(32'000'000, 'c');
  const TinyPmesh large = tiny_pmesh("a base mesh", chunk);
  ServedFolder folder;
  const std::string id = folder.publish("A large bust", large);
  Daemon daemon(folder.path());
  const std::string request =
      "GET /api/v1/models/" + id + "/file.pmesh HTTP/1.1\r\nHost: a\r\n\r\n";
  std::string requests;
  while (requests.size() < 200'000)
    requests += request;
  {
    HttpClient client(daemon.port());
    client.send(requests);
    EXPECT_EQ(client.receive(false).status, 200);
    daemon.signal(SIGTERM);
    while (accepts(daemon.port())) {
    }
    const std::string body = client.read_exactly(large.bytes.size());
    EXPECT_TRUE(std::ranges::equal(to_bytes(body), large.bytes));
    EXPECT_TRUE(client.is_closed());
  }
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

TEST(Stop, ASecondSignalEndsTheDaemonAtOnce) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon(folder.path(), {"--stop-timeout", "3600"});
  WebSocketClient stuck(daemon.port(), "/api/v1/models/" + id + "/stream", "pmesh.v1");
  stuck.receive();
  daemon.signal(SIGTERM);
  EXPECT_EQ(stuck.receive().close_code(), 1012);  // the client never answers this close frame
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

TEST(Stop, WhileItStopsItIsAliveAndNotReady) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon(folder.path(), {"--stop-timeout", "3600"});
  WebSocketClient stuck(daemon.port(), "/api/v1/models/" + id + "/stream", "pmesh.v1");
  stuck.receive();
  EXPECT_EQ(http_get(daemon.admin_port(), "/readyz").status, 200);
  daemon.signal(SIGTERM);
  EXPECT_EQ(stuck.receive().close_code(), 1012);
  EXPECT_EQ(http_get(daemon.admin_port(), "/readyz").status, 503);
  EXPECT_EQ(http_get(daemon.admin_port(), "/livez").status, 200);
  daemon.signal(SIGHUP);
  daemon.signal(SIGTERM);
  const ProgramResult result = daemon.wait();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.output.find("read again"), std::string::npos) << "it is not ready any more";
}

TEST(Stop, TheDeadlineCutsWhatDoesNotEnd) {
  ServedFolder folder;
  const std::string id = folder.publish("A small bust");
  Daemon daemon(folder.path(), {"--stop-timeout", "0"});
  WebSocketClient stuck(daemon.port(), "/api/v1/models/" + id + "/stream", "pmesh.v1");
  stuck.receive();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

}  // namespace
}  // namespace vitrine::test
