// Case files: read, checked, written again.
#include "fuzz_target.hpp"
#include "gaussdrift/read_case.hpp"

namespace gaussdrift {

FUZZ_TARGET(case) {
  try {
    case_text(parse_case(std::string(text), "/nowhere/case.toml", {}, 1).spec);
  } catch (const InputError&) {
  } catch (const FileError&) {
  } catch (const NumericalError&) {
  }
}

}  // namespace gaussdrift
