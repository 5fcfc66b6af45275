// libFuzzer's entry: the one target that this program was linked with.
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gaussdrift::fuzz::targets().front().run({reinterpret_cast<const char*>(data), size});
  return 0;
}
