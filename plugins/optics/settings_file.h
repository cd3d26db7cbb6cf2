/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <opencv2/core/persistence.hpp>
#include <string>
#include <vector>

namespace dff {

/* Both ends belong to it. NaN and infinity lie in no range. */
struct Range {
    double least = std::numeric_limits<double>::lowest();
    double most = std::numeric_limits<double>::max();
};

/* The entries of a map in a file that a user wrote: a lens profile or a calibration, as JSON, XML, or YAML of
 * one document with its first line %YAML:1.0. OpenCV's FileStorage reads it, after a look at what that does
 * not bear: size, nesting, what follows a document's end. Nothing is taken for granted of what stands in it:
 * each function throws std::runtime_error with a user's text that names the file, the entry and what it may
 * be. */
class FileEntries {
public:
    /* The outermost entries. `kind` is what messages call such a file: "The camera calibration". */
    FileEntries(std::string kind, const std::string &path);

    bool has(const char *name) const { return !find(name).empty(); }
    bool has_entries(const char *name) const { return find(name).isMap(); }

    /* Whether there is nothing of this name, or a list with nothing in it. */
    bool is_empty_list(const char *name) const;

    double number(const char *name, Range range) const;
    double number_or(const char *name, double otherwise, Range range) const;
    unsigned whole_number(const char *name, unsigned least, unsigned most) const;
    std::string text(const char *name) const;

    /* A list of numbers, with at least and at most this many. */
    std::vector<double> numbers(const char *name, size_t least, size_t most, Range range) const;

    /* A list of maps, with at least one and at most this many. */
    std::vector<FileEntries> list(const char *name, size_t most) const;

    /* The map of this name. */
    FileEntries entries(const char *name) const;

    /* The numbers of a matrix as OpenCV writes it, row by row. */
    struct Matrix {
        unsigned rows;
        unsigned columns;
        std::vector<double> values;
    };
    Matrix matrix(const char *name, unsigned most_rows, unsigned most_columns) const;

    /* A number found in `name`. */
    double checked(double value, const std::string &name, Range range) const;

    /* Throws the error: the file and then `fault`. */
    [[noreturn]] void fail(const std::string &fault) const;

private:
    struct File;
    FileEntries(std::shared_ptr<const File> file, const cv::FileNode &node, std::string place);

    cv::FileNode find(const char *name) const;
    double number_in(const cv::FileNode &node, const std::string &name, Range range) const;

    std::shared_ptr<const File> file_;
    cv::FileNode node_; /* a map of the file */
    std::string place_; /* before the names of its entries, as "planes[2]." */
};

} // namespace dff
