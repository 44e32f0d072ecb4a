#include <beltrami/differentials/dimension.h>

#include <algorithm>

namespace beltrami {

int dimension_of_differentials(int holes, int boundary_marks, int interior_marks) {
    const int least = holes == 1 ? 1 : 0;
    return std::max(least, 3 * holes - 3 + boundary_marks + 2 * interior_marks);
}

}  // namespace beltrami
