// The public face of target.hpp.
#include "accuracy/target.hpp"
#include "gaussdrift/accuracy.hpp"

namespace gaussdrift {

Case choose_settings(const Case& spec, int threads) {
  if (!spec.accuracy.target) return spec;
  return accuracy::choose_for_accuracy(spec, *spec.accuracy.target, threads).spec;
}

}  // namespace gaussdrift
