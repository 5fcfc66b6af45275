// The options of gaussdrift sum: what they are, and which go together.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"

namespace gaussdrift::cli {

/// As they were given.
struct SumOptions {
  std::string kernel = "gauss";
  std::filesystem::path sources, targets;  // targets empty: --grid, or the sources
  std::string columns;                     // "x,y" or "1,2"; empty: all but the weight
  std::string weight;                      // name or number of its column; empty: "weight"
  std::string grid;                        // "-1:1:200,-1:1:200"
  std::optional<double> sigma, shape;
  std::string bandwidth;                 // in place of sigma; empty: not given
  bool normalise = false;                // the sum becomes a density
  std::vector<std::string> derivatives;  // "0,1,2"; none: the plain sum
  std::optional<double> tolerance;       // 1e-6
  std::string method = "auto";
  std::optional<double> r;  // of `hermite` by hand, as are the next two
  std::optional<int> p;
  std::string n;                  // a number or "all"; empty: not given
  std::optional<double> seconds;  // most that may be predicted; by default 300 for a method that is named
  std::filesystem::path out;      // empty or "-": standard output
  std::string memory;             // --memory; empty: at most 8 GB
  int threads = 0;                // 0: all
  bool json = false;              // what was chosen as JSON on stdout
};

void declare_sum(OptionList& options, SumOptions& given);

/// Throws CommandLineError for what contradicts itself, and FileError for an output that cannot be one.
void check_sum_options(const SumOptions& options);

/// --bandwidth, or what --normalise takes where there is neither that nor --sigma; empty: --sigma.
std::string bandwidth_of(const SumOptions& options);

/// --r, --p or --n
bool by_hand(const SumOptions& options);
double tolerance_of(const SumOptions& options);
bool to_standard_output(const SumOptions& options);

/// Which library has the kernel; `gauss` is none of these.
bool of_pairs(const SumOptions& options);
bool of_expression(const SumOptions& options);
bool of_radial(const SumOptions& options);

}  // namespace gaussdrift::cli
