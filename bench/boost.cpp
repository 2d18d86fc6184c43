// The cells of a site in Boost.Polygon's Voronoi diagram of segments. Compiled and called by bench/boost.py.
//
// Standard input: how often to build, then the numbers of all segments and of the base site's, which come first; four whole
// numbers for each segment, the coordinates of its ends, of 32 bits.
//
// Standard output: a line with the processor seconds of each building and reading back, separated by spaces. Then a line for
// each cell, "C segment category": which end of which segment it belongs to, 1 its first and 2 its second, or 3, the segment
// itself. Then a line for each edge of the base site's cells, "E cell beyond straight" and its two ends with 17 digits,
// counter-clockwise; an end at infinity is "nan nan".

#include <boost/polygon/point_data.hpp>
#include <boost/polygon/segment_data.hpp>
#include <boost/polygon/voronoi.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

namespace {

using Diagram = boost::polygon::voronoi_diagram<double>;
using Point = boost::polygon::point_data<int>;
using Segment = boost::polygon::segment_data<int>;

struct Edge {
    std::size_t cell;
    std::size_t beyond;
    bool straight;
    double ends[4];
};

[[noreturn]] void fail(const char* message) {
    std::fprintf(stderr, "boost.cpp: %s\n", message);
    std::exit(2);
}

void put(const Diagram::vertex_type* vertex, double* point) {
    point[0] = vertex ? vertex->x() : NAN;
    point[1] = vertex ? vertex->y() : NAN;
}

std::vector<Edge> read_cells(const Diagram& diagram, std::size_t base) {
    const auto* cells = diagram.cells().data();
    std::vector<Edge> edges;
    for (const auto& cell : diagram.cells()) {
        if (cell.source_index() >= base || cell.is_degenerate()) continue;
        const auto* edge = cell.incident_edge();
        do {
            edges.push_back({static_cast<std::size_t>(&cell - cells), static_cast<std::size_t>(edge->twin()->cell() - cells),
                             edge->is_linear(), {}});
            put(edge->vertex0(), edges.back().ends);
            put(edge->vertex1(), edges.back().ends + 2);
            edge = edge->next();
        } while (edge != cell.incident_edge());
    }
    return edges;
}

int category(const Diagram::cell_type& cell) {
    if (cell.contains_segment()) return 3;
    return cell.source_category() == boost::polygon::SOURCE_CATEGORY_SEGMENT_START_POINT ? 1 : 2;
}

}  // namespace

int main() {
    int runs = 0;
    std::size_t count = 0;
    std::size_t base = 0;
    if (std::scanf("%d %zu %zu", &runs, &count, &base) != 3 || runs < 1) fail("no header");
    std::vector<Segment> segments;
    for (std::size_t k = 0; k < count; ++k) {
        int x0, y0, x1, y1;
        if (std::scanf("%d %d %d %d", &x0, &y0, &x1, &y1) != 4) fail("a segment is missing");
        segments.emplace_back(Point(x0, y0), Point(x1, y1));
    }
    Diagram diagram;
    std::vector<Edge> edges;
    for (int run = 0; run < runs; ++run) {
        diagram.clear();
        const auto begin = std::clock();
        boost::polygon::construct_voronoi(segments.begin(), segments.end(), &diagram);
        edges = read_cells(diagram, base);
        std::printf("%.9f ", static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    std::printf("\n");
    for (const auto& cell : diagram.cells()) std::printf("C %zu %d\n", cell.source_index(), category(cell));
    for (const auto& edge : edges) {
        std::printf("E %zu %zu %d %.17g %.17g %.17g %.17g\n", edge.cell, edge.beyond, edge.straight, edge.ends[0],
                    edge.ends[1], edge.ends[2], edge.ends[3]);
    }
    return 0;
}
