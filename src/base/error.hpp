// Errors by what the caller of the program can do about them; each kind has its exit code (docs/usage.md).
#pragma once

#include <stdexcept>
#include <string>

namespace gaussdrift {

enum class ExitCode { ok = 0, internal = 1, command_line = 2, input = 3, numerical = 4, check = 5, files = 6 };

/// Base of every error whose message is meant for the user.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The command line asks for something that does not exist or contradicts itself.
class CommandLineError : public Error {
 public:
  explicit CommandLineError(const std::string& message) : Error(ExitCode::command_line, message) {}
};

/// A case file, a table or a number in it is invalid; the message names place, rule and remedy.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ExitCode::input, message) {}
};

/// The run met a value that is not finite; the message names step, time, particle and place.
class NumericalError : public Error {
 public:
  explicit NumericalError(const std::string& message) : Error(ExitCode::numerical, message) {}
};

/// A file or folder exists already, cannot be read, or cannot be written.
class FileError : public Error {
 public:
  explicit FileError(const std::string& message) : Error(ExitCode::files, message) {}
};

}  // namespace gaussdrift
