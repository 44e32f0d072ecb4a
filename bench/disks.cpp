// Flattening and maps onto the round disk of real disks: faces turned over, or why there is no map.
//
//     bench_disks FOLDER... [--write OUT]
//
// FOLDERs hold meshes: disks, and closed meshes of genus 0, which are opened by a plane and by a seam. With --write the
// openings are kept in OUT as OBJ, for the command.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/beltrami.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/uniformize/fold_free_flattening.h>

#include "openings.h"

namespace {

using namespace beltrami;

std::string summary(const Distortion& measured) {
    return fmt::format("{} | {:.4f}", measured.flipped.size(), measured.mean);
}

template <class Map>
std::string tried(const Map& map) {
    try {
        return map();
    } catch (const Error& error) {
        return fmt::format("– | {}", error.what());
    }
}

void row(const std::string& name, const Mesh& mesh) {
    try {
        const Surface source(mesh);
        const std::string flat = tried([&]() -> std::string {
            const FoldFreeFlattening found = fold_free_flattening(source);
            if (!found.fold_free) return "– | folds do not open";
            return summary(distortion(source.operators, found.flattening.positions)) +
                   (found.unfolded.empty() ? "" : fmt::format(", {} unfolded", found.unfolded.size())) +
                   (found.kept_boundary ? "" : " with the boundary");
        });
        const std::string disk = tried([&]() -> std::string {
            const FoldFreeDisk found = fold_free_disk(source, round_disk_chart(source).vertices);
            if (!found.fold_free) return "– | folds do not open";
            const char* how = !found.kept_boundary       ? ", boundary by length"
                              : found.moved_boundary > 0 ? ", boundary edges given a length"
                              : found.changed            ? ", unfolded"
                                                         : "";
            return summary(distortion(source.operators, found.map)) + how;
        });
        const std::string slides = tried([&]() -> std::string {
            const ExtremalMap map = extremal_map(source, TargetDomain{TargetCurve::circle(0, 1), {}});
            return summary(map.distortion);
        });
        fmt::print("| {} | {} | {} | {} | {} | {} |\n", name, mesh.face_count(),
                   source.topology.boundary_loops[0].size(), flat, disk, slides);
    } catch (const Error& error) {
        fmt::print("| {} | {} | {} |\n", name, mesh.face_count(), error.what());
    }
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<std::filesystem::path> files;
    std::filesystem::path out;
    for (int i = 1; i < argc; ++i) {
        if (std::string(argv[i]) == "--write" && i + 1 < argc) {
            out = argv[++i];
            continue;
        }
        if (!std::filesystem::is_directory(argv[i])) {
            std::fprintf(stderr, "usage: bench_disks FOLDER... [--write OUT]\n");
            return 2;
        }
        for (const auto& entry : std::filesystem::directory_iterator(argv[i]))
            if (const auto ending = entry.path().extension();
                ending == ".obj" || ending == ".off" || ending == ".ply" || ending == ".stl")
                files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    fmt::print(
        "| disk | faces | rim | flatten: flips | mean | round disk: flips | mean | sliding onto it: flips | mean |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const auto opened = [&](const std::string& name, const Mesh& mesh) {
        if (!out.empty()) write_obj(out / (name + ".obj"), mesh);
        row(name, mesh);
    };
    for (const auto& file : files) {
        try {
            const Mesh mesh = read_mesh(file).mesh;
            const Topology shape = topology(mesh);
            const std::string name = file.stem().string();
            if (shape.components != 1 || shape.genus != 0) continue;
            if (shape.boundary_loops.size() == 1) {
                row(name, mesh);
            } else if (shape.boundary_loops.empty()) {
                opened(name + "_plane", bench::opened_by_plane(mesh));
                if (mesh.faces.corner_count() == 3 * mesh.face_count())
                    opened(name + "_seam", bench::opened_by_seam(mesh));
            }
        } catch (const Error& error) {
            fmt::print("| {} | {} |\n", file.stem().string(), error.what());
        }
    }
}
