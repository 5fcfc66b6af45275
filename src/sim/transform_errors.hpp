// Errors of the fast Gauss transform in the words of a case.
#pragma once

#include <fmt/format.h>
#include <fgtd/fgtd.hpp>

#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

/// Does the work. Where fgtd refuses it, throws InputError.
template <class Work>
auto in_words_of_a_case(const Work& work) {
  try {
    return work();
  } catch (const fgtd::MemoryLimitError& error) {
    throw InputError(
        fmt::format("summing the density would take {:.3g} GB, at most {:.3g} GB are used; lower "
                    "evaluate.per_axis or particles.per_axis",
                    error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const fgtd::Error& error) {
    throw InputError("the density cannot be summed: " +
                     base::in_users_words(error.what(), {{"Options::tolerance = ", "evaluate.tolerance = "}}) +
                     "; check the size of the domain, particles.per_axis and particles.overlap");
  }
}

}  // namespace gaussdrift
