#include "gallery/gallery.h"

namespace beltrami::gallery {

const std::vector<Entry>& figures() {
    static const std::vector<Entry> list{
        {"figure_02", figure_02}, {"figure_03", figure_03}, {"figure_07", figure_07}, {"figure_09", figure_09},
        {"figure_10", figure_10}, {"figure_11", figure_11}, {"figure_12", figure_12}, {"figure_13", figure_13},
        {"figure_14", figure_14}, {"figure_15", figure_15}, {"figure_16", figure_16}, {"figure_17", figure_17},
        {"figure_18", figure_18}, {"figure_19", figure_19}, {"corners", corners},     {"scan", scan},
        {"holes_27", holes_27},
    };
    return list;
}

}  // namespace beltrami::gallery
