// In every test program that computes: small work is shared among threads all the same. Else tests of equal bits on any
// number of threads would run on one.
#include "base/parallel.hpp"

namespace {
[[maybe_unused]] const double usual = gaussdrift::base::share_from(0);
}
