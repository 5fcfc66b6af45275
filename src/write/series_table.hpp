// series.csv: the numbers of a run, one row an output.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "gaussdrift/frame.hpp"

namespace gaussdrift::write {

constexpr const char* series_name = "series.csv";

/// Whole rows are there at every moment. `errors`: with the norms of the error, for runs that have a reference.
std::unique_ptr<Observer> series_table(const std::filesystem::path& folder, int dimension, bool errors,
                                       std::function<std::string(double t)> date = {});

}  // namespace gaussdrift::write
