// Asks the processor; see dispatch.hpp.
#include "core/dispatch.hpp"

namespace gaussdrift::core {

const std::array<InstructionSet, instruction_set_count>& instruction_sets() {
#ifdef CORE_X86
  static const std::array<InstructionSet, instruction_set_count> sets{
      {{"baseline", 2, true},
       {"avx2", 4, __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")},
       {"avx512", 8,
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
            __builtin_cpu_supports("avx512vl")}}};
#else
  static const std::array<InstructionSet, instruction_set_count> sets{
      {{"baseline", 2, true}, {"avx2", 4, false}, {"avx512", 8, false}}};
#endif
  return sets;
}

const InstructionSet& fastest_instruction_set() {
  std::size_t last = 0;
  for (std::size_t i = 0; i < instruction_set_count; ++i)
    if (instruction_sets()[i].runs) last = i;
  return instruction_sets()[last];
}

}  // namespace gaussdrift::core
