/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/settings_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace dff {

namespace {

constexpr size_t most_bytes = 1 << 20;

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
    std::ifstream stream(path, std::ios::binary);
    std::string text(most_bytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream.is_open() || stream.bad())
        fail("it cannot be read");
    text.resize(static_cast<size_t>(stream.gcount()));
    if (text.size() > most_bytes)
        fail("it has more than " + std::to_string(most_bytes >> 20) + " MiB");
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

std::vector<FileEntries> FileEntries::list(const char *name, size_t most) const
{
    const cv::FileNode node = find(name);
    if (!node.isSeq() || node.size() == 0 || node.size() > most)
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
