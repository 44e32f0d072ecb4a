#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "batch_jobs.h"

namespace beltrami::cli {

/// The name of a job's picture in its folder.
extern const char* const kThumbnail;

/// A small picture of a mesh that a job has written: its map by the texture coordinates, coloured by |μ| from 0 to 0.6,
/// or, without any, the mesh from above. As a BMP; empty where there is nothing to draw.
std::string thumbnail_of(const std::filesystem::path& mesh);

/// The summary of a batch: a page with a table that is sorted by a click on its head. Jobs that are not finished yet
/// are left out.
std::string batch_page(const std::string& title, const std::vector<BatchOutcome>& outcomes, std::size_t jobs);

}  // namespace beltrami::cli
