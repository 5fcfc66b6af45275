// The numbers of a <DataArray>: as text, or binary, inline or appended, in base64 or raw, compressed or not.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "read/xml_tree.hpp"

namespace gaussdrift::read {

/// How a file writes binary numbers, by the attributes of <VTKFile> and <AppendedData>.
struct BinaryForm {
  bool swapped = false;          // against the order of bytes of this machine
  std::size_t header_bytes = 4;  // of each length
  std::string compressor;        // empty: none
  std::optional<std::uint64_t> appended;
  bool raw = false;  // are appended data
};

/// Throws GridFileError for an attribute that it does not know.
BinaryForm binary_form(const FileBytes& file, const XmlFile& xml);

/// Is this a DataArray of numbers?
bool holds_numbers(const Element& array);
bool is_single_precision(const Element& array);

/// Throws GridFileError unless the array says that it has just `count` numbers, in as many bytes as they need at least.
/// Takes little memory, whatever the array says.
void check_length(FileBytes& file, const BinaryForm& form, const Element& array, std::size_t count);

/// The numbers of an array that check_length() has passed; values of Float32 and whole numbers as doubles. Throws
/// GridFileError: fewer or more numbers, damaged, a number that its type does not have.
std::vector<double> read_numbers(FileBytes& file, const BinaryForm& form, const Element& array, std::size_t count);

/// The first number of an array with at least one; nothing for an array without numbers.
std::optional<double> first_number(FileBytes& file, const BinaryForm& form, const Element& array);

}  // namespace gaussdrift::read
