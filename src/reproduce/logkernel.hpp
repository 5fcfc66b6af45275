// The exercises of Melenk's project sheet: the matrix ln |x_i - x_j| in blocks of low rank. Storage, error and product
// with a vector, beside the dense product and that by the fast Fourier transform.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

struct LogKernelOptions {
  std::filesystem::path folder;  // for the tables and plots; empty: none are written
  int largest_storage = 15;      // exponents of 2
  int largest_error = 10;
  int largest_product = 15;
  int largest_dense = 13;  // --full: 14, 2.1 GB
};

struct LogKernelStorage {
  std::size_t points = 0;
  int degree = 0;
  std::size_t blocks = 0, low_rank = 0;
  std::size_t doubles = 0;
  std::size_t shared = 0;  // with one basis for every set of indices
  std::size_t leaf = 0;    // with blocks of up to 16 rows or columns exact
  std::size_t both = 0;
};

struct LogKernelError {
  std::size_t points = 0;
  int degree = 0;
  double squared = 0;  // Frobenius norm
  double norm = 0;     // of the matrix, squared
};

struct LogKernelTimes {
  std::size_t points = 0;
  int degree = 0;                              // of the blocks
  std::optional<double> dense;                 // seconds of a product
  double blocks = 0, shared = 0, fourier = 0;  // the second: shared bases and larger leaves
  double difference = 0;                       // largest, of blocks and Fourier, relative
};

struct SmoothKernelError {
  int degree = 0;
  double error = 0;  // of e^(x + y), N = 256, Frobenius norm over N
};

struct LogKernelReproduction {
  std::vector<LogKernelStorage> storage;
  std::vector<LogKernelError> errors;
  std::vector<LogKernelTimes> times;
  std::vector<SmoothKernelError> smooth;
  std::vector<std::filesystem::path> files;
  double seconds = 0;
};

/// Throws FileError where a table or plot cannot be written. Where pictures cannot be drawn there are no plots.
LogKernelReproduction reproduce_logkernel(const LogKernelOptions& options,
                                          const std::function<void(const std::string&)>& progress = {});

std::string to_text(const LogKernelReproduction& result);
std::string to_json(const LogKernelReproduction& result);

}  // namespace gaussdrift::reproduce
