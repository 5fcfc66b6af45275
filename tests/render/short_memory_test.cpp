// A crash while a picture is drawn: in order where memory is short, a crash where it is not.
#include "render/short_memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "gaussdrift/error.hpp"

namespace gaussdrift::render {
namespace {

#ifdef __SANITIZE_ADDRESS__  // it takes terabytes of address space, and handles signals itself
constexpr bool can_be_limited = false;
#else
constexpr bool can_be_limited = true;
#endif

void leave_no_memory() {
  const rlimit little{1 << 20, 1 << 20}, none{0, 0};
  setrlimit(RLIMIT_AS, &little);
  setrlimit(RLIMIT_CORE, &none);
}

TEST(ShortMemoryDeathTest, EndsADrawingInOrder) {
  if (!can_be_limited) GTEST_SKIP() << "sanitized";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) {
    EXPECT_EXIT(
        {
          const WhileDrawing guard;
          leave_no_memory();
          raise(signal);
        },
        ::testing::ExitedWithCode(3), "^error: out of memory in the drawing library; [^\n]*\n$");
    EXPECT_EXIT(
        {
          const WhileDrawing guard;
          raise(signal);
        },
        ::testing::KilledBySignal(signal), "^$");
    EXPECT_EXIT(
        {
          { const WhileDrawing guard; }
          leave_no_memory();
          raise(signal);
        },
        ::testing::KilledBySignal(signal), "^$");
  }
  check_room_for_drawing();
  EXPECT_EXIT(
      {
        leave_no_memory();
        try {
          check_room_for_drawing();
        } catch (const Error& error) {
          _exit(static_cast<int>(error.code()));
        }
      },
      ::testing::ExitedWithCode(3), "");
}

}  // namespace
}  // namespace gaussdrift::render
