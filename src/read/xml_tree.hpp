// The elements of an XML file of VTK's kind: a tree of limited depth. Data between the tags are left in the file; an
// element knows where they stand. Expat reads the XML, and stops before data that are no XML.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "read/file_bytes.hpp"

namespace gaussdrift::read {

struct Element {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<Element> children;
  std::size_t line = 0;
  std::uint64_t text_begin = 0, text_end = 0;  // of the file: from the start tag to the next tag

  /// Nothing where there is no such attribute.
  const std::string* attribute(std::string_view key) const;
  /// The first child of this name; nothing where there is none.
  const Element* child(std::string_view key) const;
};

struct XmlFile {
  Element root;
  std::optional<std::uint64_t> appended;  // where the data of <AppendedData> begin
};

/// Elements that no reader here asks for are left out, with what is inside. Throws GridFileError: not well-formed,
/// nested deeply, a tag too long, a DOCTYPE.
XmlFile read_xml(FileBytes& file);

/// "wind.vti:3"
std::string line_of(const FileBytes& file, const Element& element);

}  // namespace gaussdrift::read
