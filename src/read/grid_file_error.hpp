// A data file that cannot be used: what is wrong, and what to do about it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace gaussdrift::read {

class GridFileError : public std::runtime_error {
 public:
  explicit GridFileError(const std::string& message, std::string remedy = {})
      : std::runtime_error(message), remedy_(std::move(remedy)) {}
  const std::string& remedy() const { return remedy_; }

 private:
  std::string remedy_;
};

}  // namespace gaussdrift::read
