// Kernels are compiled once for every instruction set (cmake/InstructionSets.cmake). Here a program asks, when it runs,
// which of the sets this processor has.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace gaussdrift::core {

struct InstructionSet {
  const char* name;
  std::size_t lanes;  // doubles in a vector
  bool runs;          // it is compiled, and this processor has it
};

/// Every set that kernels know, slowest first. The first runs everywhere.
constexpr std::size_t instruction_set_count = 3;
const std::array<InstructionSet, instruction_set_count>& instruction_sets();

/// The last of them that runs.
const InstructionSet& fastest_instruction_set();

/// A table of kernels for every instruction set, in the order of instruction_sets(); null where it is not compiled.
template <class Kernels>
using Tables = std::array<const Kernels*, instruction_set_count>;

/// Those that this processor runs, slowest first; at least one.
template <class Kernels>
std::vector<const Kernels*> supported(const Tables<Kernels>& tables) {
  std::vector<const Kernels*> found;
  for (std::size_t i = 0; i < tables.size(); ++i)
    if (tables[i] && instruction_sets()[i].runs) found.push_back(tables[i]);
  return found;
}

}  // namespace gaussdrift::core

// Declares `extern const Kernels name` in a namespace for every instruction set, and lists them as core::Tables. The file
// that uses these macros is DISPATCH of add_kernels() in cmake/InstructionSets.cmake.
#ifdef CORE_X86
#define CORE_DECLARE_TABLES(Kernels, name) \
  namespace baseline {                     \
  extern const Kernels name;               \
  }                                        \
  namespace avx2 {                         \
  extern const Kernels name;               \
  }                                        \
  namespace avx512 {                       \
  extern const Kernels name;               \
  }
#define CORE_TABLES(name) \
  { &baseline::name, &avx2::name, &avx512::name }
#else
#define CORE_DECLARE_TABLES(Kernels, name) \
  namespace baseline {                     \
  extern const Kernels name;               \
  }
#define CORE_TABLES(name) \
  { &baseline::name, nullptr, nullptr }
#endif
