#include "read/xml_tree.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>

#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

// VTK's files are seven deep, and their tags some hundred bytes long. Expat reads a long tag again with every block.
constexpr std::size_t deepest = 64, longest_tag = 1000000;
constexpr int block_bytes = 65536;

constexpr std::array<std::string_view, 17> known_elements{
    "VTKFile",      "Collection", "DataSet",        "ImageData", "RectilinearGrid", "Piece",
    "PointData",    "CellData",   "Coordinates",    "FieldData", "DataArray",       "Array",
    "AppendedData", "PImageData", "StructuredGrid", "Points",    "PolyData"};

bool is_known(std::string_view name) {
  return std::find(known_elements.begin(), known_elements.end(), name) != known_elements.end();
}

class Builder {
 public:
  explicit Builder(FileBytes& file) : file_(file), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const XML_Char* name, const XML_Char** attributes) {
          kept(self, [&](Builder& builder) { builder.start(name, attributes); });
        },
        [](void* self, const XML_Char*) { kept(self, [](Builder& builder) { builder.end(); }); });
    // Data end at any tag.
    XML_SetCommentHandler(parser_.get(), [](void* self, const XML_Char*) { static_cast<Builder*>(self)->end_text(); });
    XML_SetProcessingInstructionHandler(
        parser_.get(), [](void* self, const XML_Char*, const XML_Char*) { static_cast<Builder*>(self)->end_text(); });
    XML_SetStartCdataSectionHandler(parser_.get(), [](void* self) { static_cast<Builder*>(self)->end_text(); });
    XML_SetStartDoctypeDeclHandler(
        parser_.get(), [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
          kept(self, [](Builder& builder) { builder.fail("a file of data has no DOCTYPE"); });
        });
  }

  XmlFile read() {
    for (std::uint64_t at = 0; !stopped_;) {
      void* block = XML_GetBuffer(parser_.get(), block_bytes);
      if (!block) throw std::bad_alloc();
      const std::size_t got = file_.read(at, static_cast<char*>(block), block_bytes);
      at += got;
      const bool is_last = got == 0;
      const XML_Status status = XML_ParseBuffer(parser_.get(), static_cast<int>(got), is_last);
      if (error_) std::rethrow_exception(error_);
      if (stopped_) break;
      if (status != XML_STATUS_OK) fail(XML_ErrorString(XML_GetErrorCode(parser_.get())));
      if (is_last) break;
      if (const XML_Index open = XML_GetCurrentByteIndex(parser_.get());
          open >= 0 && at > static_cast<std::uint64_t>(open) + longest_tag)
        fail(fmt::format("a tag is longer than {} bytes", longest_tag));
    }
    return std::move(result_);
  }

 private:
  /// Exceptions must not pass through expat.
  template <class Work>
  static void kept(void* self, const Work& work) {
    auto& builder = *static_cast<Builder*>(self);
    if (builder.stopped_ || builder.error_) return;
    try {
      work(builder);
    } catch (...) {
      builder.error_ = std::current_exception();
      XML_StopParser(builder.parser_.get(), XML_FALSE);
    }
  }

  [[noreturn]] void fail(std::string_view why) const {
    throw GridFileError(
        fmt::format("{} is damaged: line {}: {}", file_.name(), XML_GetCurrentLineNumber(parser_.get()), why));
  }

  std::uint64_t place() const { return static_cast<std::uint64_t>(XML_GetCurrentByteIndex(parser_.get())); }

  void end_text() {
    if (text_is_open_) open_.back().text_end = place();
    text_is_open_ = false;
  }

  void start(const XML_Char* name, const XML_Char** attributes) {
    end_text();
    if (open_.size() + left_out_ >= deepest) fail(fmt::format("elements are nested more than {} deep", deepest));
    if (left_out_ > 0 || (!open_.empty() && !is_known(name))) {
      ++left_out_;
      return;
    }
    Element element;
    element.name = name;
    element.line = XML_GetCurrentLineNumber(parser_.get());
    std::size_t count = 0;
    while (attributes[2 * count]) ++count;
    element.attributes.reserve(count);
    for (std::size_t k = 0; k < count; ++k)  // an empty attribute says nothing
      if (*attributes[2 * k + 1]) element.attributes.emplace_back(attributes[2 * k], attributes[2 * k + 1]);
    element.text_begin = element.text_end =
        place() + static_cast<std::uint64_t>(XML_GetCurrentByteCount(parser_.get()));
    open_.push_back(std::move(element));
    text_is_open_ = true;
    if (open_.back().name == "AppendedData") stop_before_data();
  }

  void end() {
    end_text();
    if (left_out_ > 0) {
      --left_out_;
      return;
    }
    close();
  }

  void close() {
    Element element = std::move(open_.back());
    open_.pop_back();
    if (open_.empty())
      result_.root = std::move(element);
    else
      open_.back().children.push_back(std::move(element));
  }

  /// What follows is no XML. It begins behind an underscore.
  void stop_before_data() {
    if (open_.size() != 2) fail("<AppendedData> stands inside of another element than the first");
    std::uint64_t at = open_.back().text_begin;
    char sign = ' ';
    while (file_.read(at++, &sign, 1) == 1 && (sign == ' ' || sign == '\t' || sign == '\r' || sign == '\n')) {
    }
    if (sign != '_') fail("the data of <AppendedData> do not begin with an underscore");
    result_.appended = at;
    stopped_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
    while (!open_.empty()) close();
  }

  FileBytes& file_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  XmlFile result_;
  std::vector<Element> open_;
  std::size_t left_out_ = 0;  // open elements that nobody asks for
  bool text_is_open_ = false, stopped_ = false;
  std::exception_ptr error_;
};

}  // namespace

const std::string* Element::attribute(std::string_view key) const {
  for (const auto& [its_name, value] : attributes)
    if (its_name == key) return &value;
  return nullptr;
}

const Element* Element::child(std::string_view key) const {
  for (const Element& one : children)
    if (one.name == key) return &one;
  return nullptr;
}

XmlFile read_xml(FileBytes& file) { return Builder(file).read(); }

std::string line_of(const FileBytes& file, const Element& element) {
  return fmt::format("{}:{}", file.name(), element.line);
}

}  // namespace gaussdrift::read
