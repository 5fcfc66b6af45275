// Options::memory_limit against what is really held: every allocation of this program is counted.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "oracle/promise.hpp"

namespace {

std::atomic<long long> held{0}, peak{0};

void* counted(void* memory) {
  if (memory == nullptr) return nullptr;
  const long long now = held += static_cast<long long>(malloc_usable_size(memory));
  long long before = peak;
  while (before < now && !peak.compare_exchange_weak(before, now)) {
  }
  return memory;
}
void* uncounted(void* memory) {
  if (memory != nullptr) held -= static_cast<long long>(malloc_usable_size(memory));
  return memory;
}

}  // namespace

// The linker sends malloc and its kin of the library and of this program here (tests/CMakeLists.txt).
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
void __real_free(void* memory);
void* __wrap_malloc(std::size_t size) { return counted(__real_malloc(size)); }
void* __wrap_calloc(std::size_t count, std::size_t size) { return counted(__real_calloc(count, size)); }
void* __wrap_realloc(void* memory, std::size_t size) { return counted(__real_realloc(uncounted(memory), size)); }
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  return counted(__real_aligned_alloc(alignment, size));
}
void __wrap_free(void* memory) { __real_free(uncounted(memory)); }
}

// Not inlined: seen together, malloc here and delete there look mismatched to the compiler.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const std::size_t to = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(to, (size + to) / to * to)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace {

/// Most bytes held at once by `work`, beyond those held before.
template <class Work>
double peak_bytes(const Work& work) {
  const long long before = held;
  peak = before;
  work();
  return static_cast<double>(peak - before);
}

struct Use {
  double limit = 0;  // the smallest that is enough
  double peak = 0;   // held at that limit
  fgtd::Method method{};
};

constexpr double ignored = 100e3;  // tables of parameters, samples of points, stack-like scratch of a thread

class MemoryLimit : public testing::TestWithParam<fgtd::Method> {
 protected:
  /// Plans for points or for the grid, evaluates, sets new weights, all under the smallest limit that allows it.
  template <int d>
  Use measure(int count, double sigma, double tolerance, const fgtd::TensorGrid& grid, bool for_grid) const {
    const auto sources = naive::random_points<d>(count, 110), targets = naive::random_points<d>(2000, 111, -0.1, 1.1);
    const Eigen::MatrixXd weights = naive::random_weights(count, 2, 112);
    Use use;
    fgtd::Options options{.tolerance = tolerance, .derivative_order = 1, .method = GetParam(), .threads = 1};
    if (for_grid) options.expected_grid = grid;
    const auto work = [&] {
      fgtd::Plan<d> plan(sources, weights, sigma, options);
      use.method = plan.choice().method;
      const auto evaluate = [&] {
        if (for_grid) {
          plan.evaluate_combinations(grid, naive::value_and_gradient<d>());
        } else {
          plan.evaluate_combinations(targets, naive::value_and_gradient<d>());
        }
      };
      evaluate();
      plan.set_weights(weights);
      evaluate();
    };
    const auto enough = [&](double limit) {
      options.memory_limit = static_cast<std::size_t>(limit);
      bool done = false;
      const double bytes = peak_bytes([&] {
        try {
          work();
          done = true;
        } catch (const fgtd::MemoryLimitError& error) {
          const std::string said = error.what(),
                            number = "Options::memory_limit is " + std::to_string(options.memory_limit) + " bytes";
          EXPECT_NE(said.find(number), std::string::npos) << said;
        }
      });
      EXPECT_LE(bytes, 1.05 * limit + ignored) << (done ? "held" : "held before the refusal") << " under a limit of "
                                               << options.memory_limit << ": " << fgtd::to_string(use.method);
      if (done) use.peak = bytes;
      return done;
    };
    double low = 1e4, high = 1e9;
    EXPECT_TRUE(enough(high));
    while (high > 1.02 * low) {
      const double middle = std::sqrt(low * high);
      (enough(middle) ? high : low) = middle;
    }
    EXPECT_TRUE(enough(high));
    use.limit = high;
    return use;
  }

  template <int d>
  void expect_respected(int count, double sigma, double tolerance, int nodes) const {
    const fgtd::TensorGrid grid = naive::cube_grid<d>(nodes, -0.1, 1.1);
    for (const bool for_grid : {false, true}) {
      const Use use = measure<d>(count, sigma, tolerance, grid, for_grid);
      // an estimate made before anything is allocated may be careful, and counts blocks that small work does not fill
      EXPECT_LE(use.limit, 3 * use.peak + 20e6)
          << fgtd::to_string(use.method) << " asks for more than it needs, d = " << d << ", sigma = " << sigma
          << (for_grid ? ", grid" : ", points");
      RecordProperty(
          "d = " + std::to_string(d) + ", sigma = " + std::to_string(sigma) + (for_grid ? " grid" : " points"),
          fgtd::to_string(use.method) + ": limit " + std::to_string(use.limit) + ", held " + std::to_string(use.peak));
    }
  }
};

TEST_P(MemoryLimit, IsKeptInOneDimension) { expect_respected<1>(10000, 1e4, 1e-8, 2000); }
TEST_P(MemoryLimit, IsKeptInTwoDimensions) {
  expect_respected<2>(6000, 3.0, 1e-6, 50);
  expect_respected<2>(6000, 5e3, 1e-6, 50);
}
TEST_P(MemoryLimit, IsKeptInThreeDimensions) {
  expect_respected<3>(4000, 2.0, 1e-4, 13);
  expect_respected<3>(4000, 400.0, 1e-4, 13);
}

/// Nothing has a size that depends on sigma alone.
TEST_P(MemoryLimit, IsEnoughForEverySigma) {
  const auto sources = naive::random_points<3>(200, 113);
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(200, 1);
  for (const double sigma : {1e-12, 1e-3, 1.0, 1e3, 1e6, 1e12, 1e20}) {
    const fgtd::Options options{
        .tolerance = 1e-2, .method = GetParam(), .threads = 1, .memory_limit = std::size_t{20} << 20};
    const double bytes = peak_bytes([&] {
      const fgtd::Plan<3> plan(sources, weights, sigma, options);
      plan.evaluate(naive::cube_grid<3>(8, -1, 2));
      plan.evaluate(sources);
    });
    EXPECT_LE(bytes, 20 << 20) << sigma;
  }
}

TEST_P(MemoryLimit, IsKeptByArithmeticForGridsBeyondEveryMachine) {
  const auto sources = naive::random_points<2>(100, 114);
  const fgtd::Plan<2> plan(sources, Eigen::MatrixXd::Ones(100, 1), 4.0, {.method = GetParam(), .threads = 1});
  const fgtd::TensorGrid enormous{{naive::nodes(200000, 0, 1), naive::nodes(200000, 0, 1)}};
  EXPECT_LE(peak_bytes([&] { EXPECT_THROW(plan.evaluate(enormous), fgtd::MemoryLimitError); }),
            1200);  // the error's text
}

INSTANTIATE_TEST_SUITE_P(Memory, MemoryLimit, testing::ValuesIn(fgtd::methods()), naive::MethodName());

}  // namespace
