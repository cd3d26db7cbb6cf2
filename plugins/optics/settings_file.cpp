/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/settings_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace dff {

namespace {

constexpr std::uintmax_t most_bytes = 1 << 20;

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/* The parser calls itself for each list or map in another; on a stack of 8 MiB, 10,000 levels of them do no
 * harm. */
constexpr size_t most_marks = 2000;

bool is_one_of(std::string_view characters, char character)
{
    return characters.find(character) != std::string_view::npos;
}

/* How many lists and maps can be nested in a text at most, whichever of the three languages it is in and
 * wherever its strings and comments begin: the number of characters that can begin one. */
size_t opening_marks(std::string_view text)
{
    size_t marks = 0;
    for (size_t k = 0; k < text.size(); k++) {
        const bool dash = text[k] == '-' && (k + 1 == text.size() || is_one_of(" \t\r\n", text[k + 1]));
        marks += dash || is_one_of("[{<:", text[k]);
    }
    return marks;
}

/* The parser runs for ever, or past its buffer, on what follows the end of a document, which may also be
 * where a line begins left of the first name. So there is one document, whose names begin at the line's
 * beginning. */
bool is_one_yaml_document(std::string_view text)
{
    bool marked = false, begun = false;
    std::istringstream lines{std::string(text)};
    std::string line;
    std::getline(lines, line); /* %YAML:1.0 */
    while (std::getline(lines, line)) {
        const size_t content = line.find_first_not_of(" \t\r");
        if (line.starts_with("---")) {
            if (marked || begun || line.find_first_not_of(" \t\r", 3) != std::string::npos)
                return false;
            marked = true;
        } else if (line.starts_with("...") || line.starts_with("%")) {
            return false;
        } else if (!begun && content != std::string::npos && line[content] != '#') {
            if (content > 0 || !(std::isalnum(static_cast<unsigned char>(line[0])) || line[0] == '_'))
                return false;
            begun = true;
        }
    }
    return begun;
}

/* The parser reads at address 0 where a text ends inside a tag. So it begins and ends as one that is whole.
 */
bool is_whole_xml(std::string_view text)
{
    constexpr std::string_view end = "</opencv_storage>";
    const size_t last = text.find_last_not_of(" \t\r\n");
    const size_t comment = text.rfind("<!--"), comment_end = text.rfind("-->");
    const bool comments_end =
        comment == std::string_view::npos || (comment_end != std::string_view::npos && comment < comment_end);
    return text.substr(0, text.find('\n')).find("?>") != std::string_view::npos && comments_end &&
           text.substr(0, last + 1).ends_with(end);
}

bool is_text(std::string_view text)
{
    const auto is_control = [](unsigned char c) {
        return (c < ' ' && !is_one_of("\t\r\n", static_cast<char>(c))) || c == 0x7f;
    };
    return std::none_of(text.begin(), text.end(), is_control);
}

/* Bytes in base64, in any of the languages: the parser does not come back from damaged ones. */
bool has_binary_data(std::string_view text)
{
    return text.find("binary") != std::string_view::npos || text.find("$base64$") != std::string_view::npos;
}

std::string text_of(double value)
{
    std::ostringstream text;
    text.precision(12);
    text << (std::isnan(value) ? std::abs(value) : value); /* NaN has a sign by chance */
    return text.str();
}

std::string text_of(Range range)
{
    const bool from = range.least > Range{}.least, to = range.most < Range{}.most;
    if (from && to)
        return text_of(range.least) + " to " + text_of(range.most);
    if (from)
        return text_of(range.least) + " or more";
    return to ? text_of(range.most) + " or less" : "finite";
}

} // namespace

struct FileEntries::File {
    std::string kind;
    std::string path;
    cv::FileStorage storage;

    [[noreturn]] void fail(const std::string &fault) const
    {
        throw std::runtime_error(kind + " " + path + " cannot be used: " + fault);
    }

    std::string read() const;
    void parse(const std::string &text);
};

std::string FileEntries::File::read() const
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        fail(error ? "it cannot be opened: " + error.message() : "it is not a file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > most_bytes)
        fail("it has more than " + std::to_string(most_bytes >> 20) + " MiB");
    std::ifstream stream(path, std::ios::binary);
    std::string text(error ? 0 : size, '\0');
    if (error || !stream.read(text.data(), static_cast<std::streamsize>(text.size())))
        fail("it cannot be read");
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
        fail("it is empty");
    if (!is_text(text))
        fail("it has other characters than those of a text");
    if (text.starts_with(byte_order_mark))
        text.erase(0, byte_order_mark.size());
    if (has_binary_data(text))
        fail("it has binary data; write numbers as text");
    if (text.starts_with("%YAML") && !is_one_yaml_document(text))
        fail("it is not a single YAML document, the names of whose entries begin at the line's beginning");
    if (text.starts_with("<?xml") && !is_whole_xml(text))
        fail("it is not a whole XML document, with ?> in its first line and </opencv_storage> at its end");
    if (opening_marks(text) > most_marks)
        fail("it has more than " + std::to_string(most_marks) + " entries and lists");
    return text;
}

void FileEntries::File::parse(const std::string &text)
{
    const std::string unknown = "it is neither YAML (with a first line %YAML:1.0) nor JSON nor XML";
    try {
        storage.open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    } catch (const cv::Exception &error) {
        fail(unknown + ": " + error.err);
    } catch (const std::exception &error) { /* such as std::out_of_range, for an empty name */
        fail(unknown + ": " + error.what());
    }
    if (!storage.isOpened())
        fail(unknown);
    if (!storage.root().isMap())
        fail("it has no named entries");
}

FileEntries::FileEntries(std::string kind, const std::string &path)
{
    auto file = std::make_shared<File>();
    file->kind = std::move(kind);
    file->path = path;
    file->parse(file->read());
    node_ = file->storage.root();
    file_ = std::move(file);
}

FileEntries::FileEntries(std::shared_ptr<const File> file, const cv::FileNode &node, std::string place)
    : file_(std::move(file)), node_(node), place_(std::move(place))
{
}

void FileEntries::fail(const std::string &fault) const
{
    file_->fail(fault);
}

cv::FileNode FileEntries::find(const char *name) const
{
    return node_[name];
}

double FileEntries::number_in(const cv::FileNode &node, const std::string &name, Range range) const
{
    if (!node.isInt() && !node.isReal())
        fail(place_ + name + (node.empty() ? " is missing" : " is not a number"));
    return checked(node.real(), name, range);
}

double FileEntries::checked(double value, const std::string &name, Range range) const
{
    if (!(value >= range.least && value <= range.most))
        fail(place_ + name + " is " + text_of(value) + " and must be " + text_of(range));
    return value;
}

double FileEntries::number(const char *name, Range range) const
{
    return number_in(find(name), name, range);
}

double FileEntries::number_or(const char *name, double otherwise, Range range) const
{
    return has(name) ? number(name, range) : otherwise;
}

unsigned FileEntries::whole_number(const char *name, unsigned least, unsigned most) const
{
    const double value = number(name, {static_cast<double>(least), static_cast<double>(most)});
    if (value != std::floor(value))
        fail(place_ + name + " is " + text_of(value) + " and must be a whole number");
    return static_cast<unsigned>(value);
}

std::string FileEntries::text(const char *name) const
{
    const cv::FileNode node = find(name);
    if (!node.isString())
        fail(place_ + name + (node.empty() ? " is missing" : " is not a text"));
    return node.string();
}

std::vector<double> FileEntries::numbers(const char *name, size_t least, size_t most, Range range) const
{
    const cv::FileNode node = find(name);
    if (!node.isSeq() || node.size() < least || node.size() > most)
        fail(place_ + name + " must be a list of " +
             (least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most)) +
             " numbers");
    std::vector<double> numbers;
    for (const cv::FileNode &value : node)
        numbers.push_back(
            number_in(value, std::string(name) + "[" + std::to_string(numbers.size()) + "]", range));
    return numbers;
}

bool FileEntries::is_empty_list(const char *name) const
{
    const cv::FileNode node = find(name);
    return node.empty() || (node.isSeq() && node.begin() == node.end());
}

std::vector<FileEntries> FileEntries::list(const char *name, size_t most) const
{
    const cv::FileNode node = find(name);
    const size_t count = node.isSeq() ? node.size() : 0;
    if (count == 0 || count > most)
        fail(place_ + name + " must be a list of 1 to " + std::to_string(most));
    std::vector<FileEntries> list;
    for (const cv::FileNode &entry : node) {
        const std::string place = place_ + name + "[" + std::to_string(list.size()) + "]";
        if (!entry.isMap())
            fail(place + " has no named entries");
        list.push_back({file_, entry, place + "."});
    }
    return list;
}

FileEntries FileEntries::entries(const char *name) const
{
    const cv::FileNode node = find(name);
    if (!node.isMap())
        fail(place_ + name + (node.empty() ? " is missing" : " has no named entries"));
    return {file_, node, place_ + name + "."};
}

FileEntries::Matrix FileEntries::matrix(const char *name, unsigned most_rows, unsigned most_columns) const
{
    const FileEntries matrix = entries(name);
    const unsigned rows = matrix.whole_number("rows", 1, most_rows);
    const unsigned columns = matrix.whole_number("cols", 1, most_columns);
    const std::string type = matrix.text("dt");
    if (type.size() != 1 || !is_one_of("ucwsifdh", type[0]))
        matrix.fail(matrix.place_ + "dt is \"" + type + "\" and must be \"d\" or another type of one number");
    const size_t count = static_cast<size_t>(rows) * columns;
    return {rows, columns, matrix.numbers("data", count, count, {})};
}

} // namespace dff
