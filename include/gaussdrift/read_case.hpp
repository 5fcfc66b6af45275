/// @file
/// From a case file to a Case: parse, override, validate; and back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

/// Complaints about one case file, laid out for people (place, line, caret, rule, remedy).
class CaseError : public InputError {
 public:
  /// `count` complaints in one text.
  CaseError(const std::string& text, int count) : InputError(text), count_(count) {}
  /// How many complaints there are.
  int count() const { return count_; }

 private:
  int count_;
};

/// What reading a case gives.
struct ReadResult {
  Case spec;                          ///< complete and valid
  std::vector<std::string> warnings;  ///< laid out like the errors: unused parameters, small overlap, ...
};

/// Reads and validates. `overrides` are "key=value" with dotted keys as in --set; values have the types of the file.
/// Throws FileError (the file cannot be read) or CaseError with all errors of the file in one pass. Tables and data
/// that the case names are read as well, and fields fitted to samples on `threads` threads (0: all).
ReadResult read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                     int threads = 0);

/// The same from a text; `file` names it in messages, and data files are looked for in its folder.
ReadResult parse_case(const std::string& text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {}, int threads = 0);

/// The case as the text of a case file: defaults and overrides spelt out; reading it gives the same Case, but for
/// parameters that only stood in numbers, which are written as values. Data files are named by their absolute paths, or
/// as seen from `folder`, where the text is to lie.
std::string case_text(const Case& spec, const std::filesystem::path& folder = {});

}  // namespace gaussdrift
