#include "gallery/gallery.h"
#include "gallery/handles.h"

namespace beltrami::gallery {

namespace {

const Page& prescribed() {
    static const Page page{
        "gallery.md",
        "# Gallery\n\n"
        "Figures of Weber, Myles, Zorin, *Computing extremal quasiconformal maps*, 2012, made again with beltrami by\n"
        "`./run gallery`. Shapes that the paper does not give are made here (`problems/problems.h`), so its "
        "numbers\n"
        "are for orientation. Colours show |μ|; flipped faces are red. Tables: the estimate of k, the lower bound on K "
        "of\n"
        "the extremal map and the estimate of K ([certificate](certificate.md), the bounds of quadratic maps), and "
        "the\n"
        "statistics of |μ| over the faces, weighted by area. Iterations: linear solves, Newton steps for the methods "
        "that\n"
        "are not linear; seconds on a busy machine, bounds included. A checkerboard is that of the source on the image "
        "of a\n"
        "planar source, that of the plane on a surface in space. In histograms the last bin holds all that lies "
        "beyond.\n"
        "Boundaries that slide have a [page of their own](gallery-sliding.md).\n\n",
        {
            {"figure_01", figure_01}, {"figure_02", figure_02}, {"figure_03", figure_03}, {"figure_05", figure_05},
            {"figure_06", figure_06}, {"figure_07", figure_07}, {"figure_09", figure_09}, {"figure_10", figure_10},
            {"figure_11", figure_11}, {"figure_12", figure_12}, {"figure_13", figure_13}, {"figure_14", figure_14},
            {"figure_15", figure_15}, {"figure_16", figure_16}, {"figure_17", figure_17}, {"figure_18", figure_18},
            {"figure_19", figure_19}, {"corners", corners},     {"scan", scan},           {"holes_27", holes_27},
            {"smoothing", smoothing},
        }};
    return page;
}

const Page& sliding() {
    static const Page page{
        "gallery-sliding.md",
        "# Gallery: boundaries that slide\n\n"
        "Examples of Ng, Gu, Lui, *Computing extremal Teichmüller map of multiply-connected domains via Beltrami\n"
        "holomorphic flow*, 2014, made again with beltrami by `./run gallery`. Every boundary loop goes onto its "
        "curve,\n"
        "its points slide. Domains are the paper's where it gives them, else they are made here\n"
        "(`bench/gallery/sliding_*.cpp`). Small circles of the source go to small ellipses, all of one shape where the "
        "map\n"
        "is extremal; colours show |μ|, flipped faces are red. Tables: the estimate of k; the bracket of k of the "
        "extremal\n"
        "map by the integrals of Reich and Strebel ([certificate](certificate.md)), exact up to the errors of the "
        "mesh;\n"
        "the statistics of |μ| over the faces, weighted by area; flips, linear solves, and seconds on a busy machine,\n"
        "everything included. Meshes: edge length h, 0.4 h at the holes, which have at least 30 vertices each.\n\n",
        {
            {"sliding_given", sliding_given},
            {"sliding_01", sliding_01},
            {"sliding_values", sliding_values},
            {"sliding_04", sliding_04},
            {"sliding_05", sliding_05},
            {"sliding_06", sliding_06},
            {"sliding_08", sliding_08},
            {"sliding_09", sliding_09},
            {"sliding_12", sliding_12},
            {"sliding_13", sliding_13},
            {"sliding_classes", sliding_classes},
            {"sliding_distance", sliding_distance},
            {"sliding_distance_scans", sliding_distance_scans},
            {"sliding_mixed", sliding_mixed},
        }};
    return page;
}

const Page& sphere() {
    static const Page page{"gallery-sphere.md",
                           "# Gallery: the sphere\n\n"
                           "Maps of closed surfaces of genus 0, made by `./run gallery`. Seconds on a busy "
                           "machine.\n\n",
                           {{"spheres", spheres}, {"registrations", registrations}, {"transfers", transfers}}};
    return page;
}

const Page& handles() {
    static const Page page{"gallery-tori.md",
                           "# Gallery: tori\n\n"
                           "Extremal maps between closed surfaces of genus 1, made by `./run gallery`.\n\n",
                           {{"tori", tori}}};
    return page;
}

const Page& flows() {
    static const Page page{
        "gallery-flow.md",
        "# Gallery: flows along surfaces\n\n"
        "Examples of Wong, Zhao, *Computation of quasiconformal surface maps using discrete Beltrami flow*,\n"
        "2014, made again with beltrami by `./run gallery` ([prescribed coefficients](flow.md)). Seconds on a\n"
        "busy machine.\n\n",
        {{"flow_disk", flow_disk},
         {"flow_sphere", flow_sphere},
         {"flow_unfolding", flow_unfolding},
         {"flow_annulus", flow_annulus},
         {"flow_curves", flow_curves},
         {"flow_square", flow_square},
         {"flow_tori", flow_tori}}};
    return page;
}

const Page& higher_genus() {
    static const Page page{"gallery-genus.md",
                           "# Gallery: higher genus\n\n"
                           "Extremal maps between surfaces of genus 2 and 3, and between surfaces with a boundary as\n"
                           "halves of their doubles, made by `./run gallery`.\n\n",
                           {{"genus", genus},
                            {"genus_deformed", genus_deformed},
                            {"genus_twists", genus_twists},
                            {"genus_three", genus_three},
                            {"genus_scan", genus_scan},
                            {"genus_search", genus_search},
                            {"genus_distance", genus_distance},
                            {"genus_boundary", genus_boundary},
                            {"genus_open_scans", genus_open_scans},
                            {"genus_starts", genus_starts}}};
    return page;
}

const Page& into_space() {
    static const Page page{
        "gallery-space.md",
        "# Gallery: maps into space and shapes of faces\n\n"
        "Examples of Gruber, Aulisa, *Quasiconformal mappings for surface mesh optimization*, 2022, made again with\n"
        "beltrami by `./run gallery` ([maps into space](space.md), [deformation](deform.md), [remeshing](remesh.md)).\n"
        "Least squares and QC iteration are the paper's, corrected.\n\n",
        {{"space_01", space_01},
         {"space_02", space_02},
         {"space_05", space_05},
         {"space_06", space_06},
         {"space_09", space_09},
         {"space_10", space_10},
         {"space_14", space_14},
         {"space_17", space_17},
         {"space_18", space_18},
         {"space_20", space_20},
         {"space_steps", space_steps}}};
    return page;
}

}  // namespace

const std::vector<Page>& pages() {
    static const std::vector<Page> list{prescribed(),   sliding(), sphere(),    handles(),
                                        higher_genus(), flows(),   into_space()};
    return list;
}

}  // namespace beltrami::gallery
