// The arithmetic of blocker_kernel.hpp; core/wide.inl says where this is compiled.
#include "transfer/vector_parts.inl"

NACRE_INLINE Columns columnsAt(const std::vector<float>* xyz, std::size_t i) {
    return {load(&xyz[0][i]), load(&xyz[1][i]), load(&xyz[2][i])};
}

/// The test of belowHorizon (receiver_groups.hpp).
NACRE_INLINE Mask mayRise(const GroupBounds& group, const Columns& d, const Floats& distance, const Floats& radius) {
    const Floats radii = radius + splat(group.radius);
    return dot(group.normal, d) + splat(glm::length(group.normal)) * radii + splat(group.spread) * (distance + radii) >= Floats{};
}

/// Distance of a point from sixteen triangles: to the plane where the point stands over the triangle, else to an edge.
NACRE_INLINE Floats distanceFrom(const std::vector<float>* corners, std::size_t i, const glm::vec3& point) {
    Columns at[3];
    for (int c = 0; c < 3; ++c) at[c] = columnsAt(corners + 3 * c, i) - point;
    const Columns n = cross(at[1] - at[0], at[2] - at[0]);
    Floats toEdges = splat(1e30f);
    Mask over = Mask{} - 1;
    for (int c = 0; c < 3; ++c) {
        const Columns &a = at[c], edge = at[(c + 1) % 3] - a;
        over &= dot(n, cross(edge, a)) <= Floats{};  // the point, the origin, on the inner side of the edge
        Floats along = -dot(a, edge) / (dot(edge, edge) + splat(1e-30f));
        along = smaller(larger(along, Floats{}), splat(1));
        const Columns foot{a.x + along * edge.x, a.y + along * edge.y, a.z + along * edge.z};
        toEdges = smaller(toEdges, dot(foot, foot));
    }
    const Floats height = dot(n, at[0]), area = dot(n, n);
    return root(choose(over & (area > Floats{}), height * height / (area + splat(1e-30f)), toEdges));
}

typedef std::uint8_t Bytes __attribute__((vector_size(kWide)));

void choose(const PatchColumns& patches, const GroupBounds& group, float angle, std::uint8_t* levels,
            std::uint16_t* hidden) {
    for (std::size_t i = 0; i < patches.count; i += kWide) {
        const Columns d = columnsAt(patches.centre, i) - group.centre;
        const Floats distance = lengthOf(d);
        const unsigned below = lanes(~mayRise(group, d, distance, load(&patches.radius[i])));
        hidden[i / kWide] = static_cast<std::uint16_t>(below);
        if (below == 0xffff) {
            store(levels + i, Bytes{});
            continue;
        }
        const Floats nearest = distanceFrom(patches.corners, i, group.centre);
        // What touches the group is fine until the angle is large: there an error is seen from no distance at all.
        const Floats allowed = splat(angle) * larger(nearest - splat(group.radius), splat(0.2f * angle) * distance);
        Mask level{};
        for (std::size_t l = 1; l < patches.off.size(); ++l)
            level = load(&patches.off[l][i]) <= allowed ? Mask{} + static_cast<std::int32_t>(l) : level;
        store(levels + i, __builtin_convertvector(level, Bytes));
    }
}

std::size_t cull(const ListedBlockers& list, const Receiver& receiver, std::uint32_t* out) {
    const glm::vec3 p = receiver.point, n = receiver.normal;
    const Floats height = splat(n.x * p.x + n.y * p.y + n.z * p.z);
    const float* column[12];
    const float* offset = list.columns[12].data();
    for (int c = 0; c < 12; ++c) column[c] = list.columns[c].data();
    const auto at = [&](int c, std::size_t i) {
        return Columns{load(column[c] + i), load(column[c + 1] + i), load(column[c + 2] + i)};
    };
    Mask numbers{};
    for (int k = 0; k < kWide; ++k) numbers[k] = k;
    std::size_t found = 0;
    const std::size_t count = list.count;
    for (std::size_t i = 0; i < count; i += kWide) {
        const Floats z = larger(larger(dot(n, at(0, i)), dot(n, at(3, i))), dot(n, at(6, i)));
        const Mask keep = (z > height) & (dot(p, at(9, i)) > load(offset + i));
        const unsigned used = count - i >= kWide ? 0xffffu : (1u << (count - i)) - 1;
        found = append(out, found, numbers + static_cast<std::int32_t>(i), lanes(keep) & used);
    }
    return found;
}
