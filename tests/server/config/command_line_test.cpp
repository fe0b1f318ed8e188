// SPDX-License-Identifier: Apache-2.0
#include "server/config/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "server/config/options.h"

namespace vitrine::server {
namespace {

using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Words = std::vector<std::string_view>;

Expected<CommandLine> parse(const Words& arguments, const Words& environment = {},
                            const std::string& file = "") {
  return parse_command_line(arguments, environment,
                            [&](const std::string&) -> Expected<std::string> { return file; });
}

TEST(CommandLine, StartsFromTheDefaultsOfTheTable) {
  const auto line = parse({});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->settings.listen, (Endpoint{"127.0.0.1", 8080}));
  EXPECT_EQ(line->settings.data, "./data");
  EXPECT_EQ(line->settings.stop_timeout, std::chrono::seconds(20));
}

TEST(CommandLine, TheFileWinsOverDefaultsTheEnvironmentOverTheFileAndFlagsOverAll) {
  const std::string file = "# a comment\nlisten = 127.0.0.1:1\n\nthreads=3\ndata = \"in file\"\r\n";
  const Words environment = {"VITRINE_LISTEN=127.0.0.1:2", "VITRINE_THREADS=4", "HOME=/root"};
  const auto line =
      parse({"--config", "vitrine.conf", "--listen", "127.0.0.1:3"}, environment, file);
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->settings.listen.port, 3);
  EXPECT_EQ(line->settings.threads, 4u);
  EXPECT_EQ(line->settings.data, "in file");
}

TEST(CommandLine, AListenerMayBeAUnixSocket) {
  const auto line = parse({"--listen", "unix:/run/vitrine.sock"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->settings.listen, Endpoint{.path = "/run/vitrine.sock"});
  EXPECT_FALSE(parse({"--listen", "unix:"}));
  const std::string too_long = "unix:/" + std::string(107, 'x');
  EXPECT_FALSE(parse({"--listen", too_long}));
}

TEST(CommandLine, AnUnknownFlagIsAnErrorWithASuggestion) {
  const auto line = parse({"--lisen", "127.0.0.1:1"});
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error().message, HasSubstr("'--lisen'; did you mean '--listen'?"));
}

TEST(CommandLine, AnUnknownKeyInTheFileNamesTheFileAndTheLine) {
  const auto line = parse({"--config", "v.conf"}, {}, "data = x\n\ntreads = 4\n");
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error().message,
              HasSubstr("v.conf:3: unknown key 'treads'; did you mean 'threads'?"));
}

TEST(CommandLine, AnUnknownEnvironmentVariableIsAnErrorWithASuggestion) {
  const auto line = parse({}, {"VITRINE_LISTNE=127.0.0.1:1"});
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error().message, HasSubstr("did you mean 'VITRINE_LISTEN'?"));
}

TEST(CommandLine, VariablesThatKubernetesSetsForAServiceOfThisNameAreIgnored) {
  EXPECT_TRUE(parse({}, {"VITRINE_PORT=tcp://10.0.0.1:80", "VITRINE_SERVICE_HOST=10.0.0.1",
                         "VITRINE_PORT_80_TCP_ADDR=10.0.0.1"}));
  EXPECT_FALSE(parse({}, {"VITRINE_PORT=8080"}));
}

TEST(CommandLine, VariablesOfTheTestsAreIgnored) {
  EXPECT_TRUE(parse({}, {"VITRINE_MODELS=/m", "VITRINE_FUZZ_SECONDS=9", "VITRINE_CHROMIUM=/c",
                         "VITRINE_NO_SKIPS=1"}));
}

TEST(CommandLine, RefusesValuesOutOfRangeAndSaysWhereTheyCameFrom) {
  const auto port = parse({"--listen", "127.0.0.1:65536"});
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().message,
            "--listen: '65536' is not a whole number from 0 to 65535; correct it");
  EXPECT_THAT(parse({}, {"VITRINE_THREADS=x"}).error().message, StartsWith("VITRINE_THREADS: 'x'"));
  EXPECT_THAT(parse({"--config", "v.conf"}, {}, "\nthreads = x\n").error().message,
              StartsWith("v.conf:2: threads: 'x'"));
  EXPECT_FALSE(parse({"--listen", "8080"}));
  EXPECT_FALSE(parse({"--threads", "-1"}));
  EXPECT_FALSE(parse({"--stop-timeout", "1s"}));
  EXPECT_FALSE(parse({}, {"VITRINE_MAX_CONNECTIONS=0"}));
}

TEST(CommandLine, OneAddressMayHaveANumberOfConnectionsOrAShare) {
  const auto connections = [](std::string_view text) {
    const auto line = parse({"--max-connections-per-address", text});
    return line ? connections_of(line->settings.max_connections_per_address, 300) : 0;
  };
  EXPECT_EQ(connections_of(parse({})->settings.max_connections_per_address, 300), 30u);
  EXPECT_EQ(connections("25%"), 75u);
  EXPECT_EQ(connections("7"), 7u);
  EXPECT_EQ(connections("0"), SIZE_MAX);
  EXPECT_EQ(connections_of({.value = 10, .is_percentage = true}, 1), 1u);
  for (const char* wrong : {"0%", "101%", "%", "-1", "10 %", "1000001"})
    EXPECT_EQ(connections(wrong), 0u) << wrong;
}

TEST(CommandLine, HostsAreNamesWithoutPorts) {
  EXPECT_THAT(parse({"--hosts", "museum.example,intranet"})->settings.hosts,
              ::testing::ElementsAre("museum.example", "intranet"));
  for (const char* wrong : {"a,,b", "museum.example:80", "https://museum.example", "a b"})
    EXPECT_FALSE(parse({"--hosts", wrong})) << wrong;
}

TEST(CommandLine, EveryFaultEndsWithTheNextStep) {
  for (const Words& words :
       {Words{"--listen", "8080"}, Words{"--listen", "museum:80"}, Words{"--listen", "127.0.0.1:x"},
        Words{"--threads", "-1"}, Words{"--data", ""}, Words{"--data"}, Words{"--lisen", "x"}}) {
    EXPECT_THAT(parse(words).error().message, HasSubstr("; "));
  }
  EXPECT_THAT(parse({"--config", "v.conf"}, {}, "[server]\n").error().message,
              Eq("v.conf:1: '[server]' is not 'key = value'; correct the line"));
}

TEST(CommandLine, AFlagWithoutItsValueIsAnError) {
  const auto line = parse({"--data"});
  ASSERT_FALSE(line);
  EXPECT_THAT(line.error().message, HasSubstr("--data needs a value"));
}

TEST(CommandLine, AValueMayFollowAnEqualsSign) {
  const auto line = parse({"--data=here=there", "--listen=[::1]:90"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->settings.data, "here=there");
  EXPECT_EQ(line->settings.listen, (Endpoint{"::1", 90}));
}

TEST(CommandLine, ALineThatIsNoAssignmentIsAnError) {
  EXPECT_FALSE(parse({"--config", "v.conf"}, {}, "[server]\n"));
}

TEST(CommandLine, AMissingConfigurationFileIsTheReadersError) {
  const std::vector<std::string_view> arguments = {"--config", "none"};
  const auto line =
      parse_command_line(arguments, {}, [](const std::string& path) -> Expected<std::string> {
        return fail(ErrorCode::kIo, path + ": no such file");
      });
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().message, "none: no such file");
}

TEST(CommandLine, ThePrintedConfigurationGivesTheSameSettingsWhenRead) {
  const auto line = parse({"--threads", "7", "--data", "a b"});
  ASSERT_TRUE(line);
  const auto again = parse({"--config", "x"}, {}, print_config(*line));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->settings.threads, 7u);
  EXPECT_EQ(again->settings.data, "a b");
}

TEST(CommandLine, SecretsAreNotPrintedNorRepeatedInFaults) {
  const auto line = parse({"--store", "s3://models", "--store-secret-key", "hush"},
                          {"VITRINE_CATALOGUE=postgresql://museum:hush@db/vitrine"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->settings.catalogue, "postgresql://museum:hush@db/vitrine");
  EXPECT_THAT(print_config(*line), HasSubstr("s3://models"));
  EXPECT_THAT(print_config(*line), testing::Not(HasSubstr("hush")));
  const auto fault = parse({"--catalogue", "mysql://museum:hush@db/vitrine"});
  ASSERT_FALSE(fault);
  EXPECT_EQ(fault.error().message,
            "--catalogue: the URL does not begin with postgresql://; correct it");
}

TEST(CommandLine, ASecretOfWebhooksThatIsNoKeyIsRefused) {
  const auto line = parse({"--webhook-secret", "whsec_MDEyMzQ1Njc4OTAxMjM0NTY3ODkwMTIz"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->settings.webhook_key, "012345678901234567890123");
  EXPECT_THAT(print_config(*line), testing::Not(HasSubstr("MDEy")));
  for (const char* secret :
       {"hush", "whsec_", "whsec_aHVzaA==", "whsec_MDEyMzQ1Njc4OTAxMjM0NTY3ODkwMTIzhush!",
        "MDEyMzQ1Njc4OTAxMjM0NTY3ODkwMTIz", "whsec_MDEyMzQ1Njc4OTAxMjM0NTY3ODkwMTI"}) {
    const auto fault = parse({"--webhook-secret", secret});
    ASSERT_FALSE(fault) << secret;
    EXPECT_THAT(fault.error().message, HasSubstr("--webhook-secret: the secret is not whsec_"));
    EXPECT_THAT(fault.error().message, testing::Not(HasSubstr("hush")));
  }
}

TEST(CommandLine, AddressesInLogsAreFullOrShort) {
  EXPECT_FALSE(parse({})->settings.shortens_addresses);
  EXPECT_TRUE(parse({"--log-addresses", "short"})->settings.shortens_addresses);
  EXPECT_EQ(parse({"--log-addresses", "none"}).error().message,
            "--log-addresses: 'none' is not a form of addresses; give full or short");
}

TEST(CommandLine, VisitsAreCountedUnlessTheSettingSaysNo) {
  EXPECT_TRUE(parse({})->settings.counts_visits);
  EXPECT_TRUE(parse({"--count-visits", "yes"})->settings.counts_visits);
  EXPECT_FALSE(parse({"--count-visits", "no"})->settings.counts_visits);
  EXPECT_EQ(parse({"--count-visits", "0"}).error().message,
            "--count-visits: '0' is neither yes nor no; give one");
}

TEST(CommandLine, ADaemonHasTheGivenRolesByDefaultAll) {
  const auto all = parse({}), some = parse({"--roles", "scan,build"});
  ASSERT_TRUE(all && some);
  EXPECT_TRUE(all->settings.roles.serves && all->settings.roles.builds &&
              all->settings.roles.scans);
  EXPECT_FALSE(some->settings.roles.serves);
  EXPECT_TRUE(some->settings.roles.builds && some->settings.roles.scans);
  EXPECT_THAT(
      parse({"--roles", "serve,bild"}).error().message,
      HasSubstr("--roles: 'bild' is not a role; give one or more of serve, build and scan"));
  EXPECT_FALSE(parse({"--roles", ""}));
}

// Returns the text with wrapped lines joined again.
std::string unwrapped(const std::string& text) {
  return std::regex_replace(text, std::regex("\\s+"), " ");
}

TEST(CommandLine, TheReferenceNamesEveryOption) {
  const std::string text = unwrapped(reference());
  for (const Option& option : options()) {
    EXPECT_THAT(text, HasSubstr("--" + std::string(option.key)));
    EXPECT_THAT(text, HasSubstr(std::string(option.doc)));
  }
}

TEST(CommandLine, KeysAndVariablesAreUnique) {
  std::set<std::string> names;
  for (const Option& option : options()) {
    EXPECT_TRUE(names.insert(environment_name(option)).second) << option.key;
  }
}

TEST(CommandLine, KnowsItsActions) {
  EXPECT_EQ(parse({"--help"})->action, Action::kHelp);
  EXPECT_EQ(parse({"--version"})->action, Action::kVersion);
  EXPECT_EQ(parse({"--check-config"})->action, Action::kCheckConfig);
  EXPECT_EQ(parse({"--print-config"})->action, Action::kPrintConfig);
  EXPECT_FALSE(parse({"--check-config", "--listen", "nowhere"}));
}

}  // namespace
}  // namespace vitrine::server
