// The cells of a site in CGAL's segment Delaunay graph. Compiled and called by bench/cgal.py.
//
// Standard input: the numbers of nodes and segments, then those of the base site's, whose nodes and segments come
// first; two coordinates for each node; two node numbers for each segment. Segments meet at common nodes only.
//
// Standard output: the processor seconds that building and reading back took, then one line for each edge of the cells of the base
// site's elements: cell, cell beyond, and the two ends with 17 digits, counter-clockwise. Cells are numbered as the
// elements are: nodes, then segments (open ones: an end point has a cell of its own). An end at infinity is "nan nan".
//
// The traits: filtered, for segments that do not cross (Segment_Delaunay_graph_filtered_traits_without_intersections_2).
// Predicates are exact: interval arithmetic with square roots first, a ring of exact numbers where that does not decide.
// The ring is Gmpzf, faster here than Gmpq, CGAL's default. Vertices are constructed in doubles, with square roots.

#include <CGAL/Gmpzf.h>
#include <CGAL/Segment_Delaunay_graph_2.h>
#include <CGAL/Segment_Delaunay_graph_filtered_traits_2.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <random>
#include <unordered_map>
#include <utility>
#include <vector>

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Ring = CGAL::Simple_cartesian<CGAL::Gmpzf>;
using Traits = CGAL::Segment_Delaunay_graph_filtered_traits_without_intersections_2<
    Kernel, CGAL::Field_with_sqrt_tag, Ring, CGAL::Integral_domain_without_division_tag>;
using Graph = CGAL::Segment_Delaunay_graph_2<Traits>;
using Point = Kernel::Point_2;
using Handle = Graph::Vertex_handle;

struct Input {
    std::vector<Point> nodes;
    std::vector<std::pair<int, int>> segments;
    int base_nodes = 0;
    int base_segments = 0;
};

struct Edge {
    int cell;
    int beyond;
    Point start;
    Point end;
};

[[noreturn]] void fail(const char* message) {
    std::fprintf(stderr, "cgal.cpp: %s\n", message);
    std::exit(2);
}

Input read_input() {
    Input input;
    int nodes = 0;
    int segments = 0;
    if (std::scanf("%d %d %d %d", &nodes, &segments, &input.base_nodes, &input.base_segments) != 4) fail("no header");
    for (int k = 0; k < nodes; ++k) {
        double x = 0;
        double y = 0;
        if (std::scanf("%lf %lf", &x, &y) != 2) fail("a node is missing");
        input.nodes.emplace_back(x, y);
    }
    for (int k = 0; k < segments; ++k) {
        int i = 0;
        int j = 0;
        if (std::scanf("%d %d", &i, &j) != 2) fail("a segment is missing");
        input.segments.emplace_back(i, j);
    }
    return input;
}

// As Graph::insert_segments does it: points along a space-filling curve, each located from the one before, and then the
// segments between them. Done here for the handles, which say what a vertex of the graph stands for; and the segments come
// in random order, which is faster for a fine curve than one after the other along it.
std::vector<Handle> build(const Input& input, Graph& graph) {
    std::vector<std::size_t> order(input.nodes.size());
    std::iota(order.begin(), order.end(), 0);
    auto map = CGAL::make_property_map(input.nodes);
    CGAL::spatial_sort(order.begin(), order.end(), CGAL::Spatial_sort_traits_adapter_2<Kernel, decltype(map)>(map));
    std::vector<Handle> handles(input.nodes.size());
    Handle near;
    for (const auto k : order) near = handles[k] = graph.insert(input.nodes[k], near);
    std::vector<std::size_t> turns(input.segments.size());
    std::iota(turns.begin(), turns.end(), 0);
    std::shuffle(turns.begin(), turns.end(), std::mt19937(1));
    handles.resize(input.nodes.size() + input.segments.size());
    for (const auto k : turns) {
        const auto [i, j] = input.segments[k];
        handles[input.nodes.size() + k] = graph.insert(handles[i], handles[j]);
    }
    return handles;
}

Point centre(const Graph& graph, Graph::Face_handle face) {
    return graph.is_infinite(face) ? Point(NAN, NAN) : graph.primal(face);
}

std::vector<Edge> read_cells(const Input& input, const Graph& graph, const std::vector<Handle>& handles) {
    std::unordered_map<const Graph::Vertex*, int> number;
    for (std::size_t k = 0; k < handles.size(); ++k) number[&*handles[k]] = static_cast<int>(k);
    if (number.size() != handles.size()) fail("two elements are one");
    std::vector<Edge> edges;
    for (int k = 0; k < input.base_nodes + input.base_segments; ++k) {
        const int cell = k < input.base_nodes ? k : static_cast<int>(input.nodes.size()) + k - input.base_nodes;
        auto edge = graph.incident_edges(handles[cell]);
        const auto done = edge;
        do {
            // Around a vertex the faces follow counter-clockwise, and so do the ends of its cell's edges.
            const auto [face, side] = *edge;
            const Handle beyond = face->vertex(Graph::cw(side)) == handles[cell] ? face->vertex(Graph::ccw(side))
                                                                                : face->vertex(Graph::cw(side));
            Graph::Face_handle before = face;
            Graph::Face_handle after = face->neighbor(side);
            if (face->vertex(Graph::ccw(side)) == handles[cell]) std::swap(before, after);
            const int other = graph.is_infinite(beyond) ? -1 : number.at(&*beyond);
            edges.push_back({cell, other, centre(graph, before), centre(graph, after)});
        } while (++edge != done);
    }
    return edges;
}

}  // namespace

int main() {
    const Input input = read_input();
    const auto begin = std::clock();
    Graph graph;
    const auto handles = build(input, graph);
    const auto edges = read_cells(input, graph, handles);
    std::printf("%.9f\n", static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    for (const auto& edge : edges) {
        std::printf("%d %d %.17g %.17g %.17g %.17g\n", edge.cell, edge.beyond, edge.start.x(), edge.start.y(),
                    edge.end.x(), edge.end.y());
    }
    return 0;
}
