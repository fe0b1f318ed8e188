// SPDX-License-Identifier: Apache-2.0
// Tests that no task loses its turn if memory runs out.
#include "support/counting_new.h"
#include "turns.h"

namespace vitrine::server {
namespace {

// Calls `action` and lets its allocation number `n` fail. Returns false if `action` allocates less
// than `n` times.
template <class Action>
bool fails(std::size_t n, const Action& action) {
  const std::size_t before = test::allocations();
  test::fail_allocation(n);
  action();
  test::fail_allocation(0);
  return test::allocations() - before >= n;
}

using TurnsWithoutMemory = test::Turns;

TEST_F(TurnsWithoutMemory, TheEndOfATurnLosesNoTaskThatWaits) {
  std::size_t n = 1;
  for (bool has_failed = true; has_failed; ++n) {
    turns = std::make_shared<FairTurns>(2, 1);
    order.clear();
    begin("a1", "x");
    begin("b1", "y");
    begin("a2", "y");
    begin("c1", "x");
    ASSERT_EQ(order, "a1 b1 ");
    has_failed = fails(n, [&] { end_without_running_others("a1"); });
    wait_for_the_turn_of("c1");
    end("b1");
    wait_for_the_turn_of("a2");
    end("a2");
    end("c1");
  }
  EXPECT_GT(n, 2u);
}

}  // namespace
}  // namespace vitrine::server
