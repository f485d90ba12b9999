#include "factorize/micro/gonioreflectometer.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/sampling.hpp"

namespace nacre {

namespace {
/// What the facets see: of the sky in the table's directions, and of each other.
struct Transport {
    std::size_t directions = 0, rays = 0;
    std::vector<double> weights;       ///< w_p(d), [facet][direction]
    std::vector<double> projected;     ///< W(d)
    std::vector<std::ptrdiff_t> hits;  ///< [facet][ray], -1: sky
    double area = 0;                   ///< A
};
}  // namespace

/// Rotates a direction about +z to one about `normal` (Frisvad's frame would be singular at -z; normals have z > 0).
static Vec3 aboutNormal(const Vec3& d, const Vec3& normal) {
    const Vec3 tangent = glm::normalize(Vec3(normal.z, 0, -normal.x));
    return d.x * tangent + d.y * cross(normal, tangent) + d.z * normal;
}

/// Cosine-weighted, a Halton set shifted by a different offset on every facet.
static Vec3 gatherDirection(const Facet& facet, std::size_t index, std::size_t ray) {
    const double u = radicalInverse(ray + 1, 2) + radicalInverse(index + 1, 5);
    const double v = radicalInverse(ray + 1, 3) + radicalInverse(index + 1, 7);
    return aboutNormal(cosineHemisphere({u - std::floor(u), v - std::floor(v)}), facet.normal);
}

static Transport trace(std::span<const Facet> facets, const SurfaceTracer& tracer,
                       const GonioreflectometerOptions& options) {
    Transport out;
    out.directions = static_cast<std::size_t>(options.resolution) * static_cast<std::size_t>(options.resolution);
    out.rays = options.bounces > 0 ? static_cast<std::size_t>(options.rays) : 0;
    out.weights.resize(facets.size() * out.directions);
    out.hits.resize(facets.size() * out.rays);
    std::vector<Vec3> directions;
    for (std::size_t d = 0; d < out.directions; ++d) directions.push_back(nodeDirection(options.resolution, d));
    parallelFor(facets.size(), options.threads, [&](std::size_t p) {
        const Facet& facet = facets[p];
        for (std::size_t d = 0; d < out.directions; ++d) {
            const double cosine = dot(facet.normal, directions[d]);
            if (cosine > 0 && tracer.escapes(facet.centre, directions[d]))
                out.weights[p * out.directions + d] = facet.area * cosine;
        }
        for (std::size_t r = 0; r < out.rays; ++r)
            out.hits[p * out.rays + r] = tracer.firstHit(facet.centre, gatherDirection(facet, p, r));
    });
    out.projected.assign(out.directions, 0.0);
    for (std::size_t p = 0; p < facets.size(); ++p) {
        out.area += facets[p].area * facets[p].normal.z;
        for (std::size_t d = 0; d < out.directions; ++d) out.projected[d] += out.weights[p * out.directions + d];
    }
    return out;
}

/// B_p for unit irradiance across wi.
static std::vector<Rgb> radiosity(std::span<const Facet> facets, const Transport& transport, std::size_t wi,
                                  int bounces) {
    std::vector<double> direct(facets.size());
    std::vector<Rgb> current(facets.size()), next(facets.size());
    for (std::size_t p = 0; p < facets.size(); ++p) {
        direct[p] = transport.weights[p * transport.directions + wi] / facets[p].area;
        current[p] = direct[p] * facets[p].albedo;
    }
    for (int bounce = 0; bounce < bounces; ++bounce) {
        for (std::size_t p = 0; p < facets.size(); ++p) {
            Rgb gathered(0);
            for (std::size_t r = 0; r < transport.rays; ++r) {
                const std::ptrdiff_t hit = transport.hits[p * transport.rays + r];
                if (hit >= 0) gathered += current[static_cast<std::size_t>(hit)];
            }
            next[p] = facets[p].albedo * (direct[p] + gathered / static_cast<double>(transport.rays));
        }
        current.swap(next);
    }
    return current;
}

/// f(wi, ·) before the symmetric mean.
static std::vector<Rgb> measureRow(std::span<const Facet> facets, const Transport& transport, std::size_t wi,
                                   int bounces) {
    const std::vector<Rgb> leaving = radiosity(facets, transport, wi, bounces);
    std::vector<double> red(transport.directions), green(transport.directions), blue(transport.directions);
    for (std::size_t p = 0; p < facets.size(); ++p) {
        const Rgb b = leaving[p];
        if (maxComponent(b) == 0) continue;
        const double* weights = &transport.weights[p * transport.directions];
        for (std::size_t d = 0; d < transport.directions; ++d) {
            red[d] += b.r * weights[d];
            green[d] += b.g * weights[d];
            blue[d] += b.b * weights[d];
        }
    }
    std::vector<Rgb> row(transport.directions, Rgb(0));
    for (std::size_t d = 0; d < transport.directions; ++d) {
        const double seen = transport.projected[wi] * transport.projected[d];
        if (seen > 0) row[d] = Rgb(red[d], green[d], blue[d]) * (transport.area / (kPi * seen));
    }
    return row;
}

DirectionTable simulateReflectance(std::span<const Facet> facets, const SurfaceTracer& tracer,
                                   const GonioreflectometerOptions& options) {
    require(!facets.empty() && options.resolution >= 2 && options.bounces >= 0 && options.rays >= 1,
            "simulateReflectance: needs facets, resolution >= 2, bounces >= 0, rays >= 1");
    const Transport transport = trace(facets, tracer, options);
    const std::size_t nodes = transport.directions;
    std::vector<std::vector<Rgb>> rows(nodes);
    parallelFor(nodes, options.threads,
                [&](std::size_t wi) { rows[wi] = measureRow(facets, transport, wi, options.bounces); });
    DirectionTable table{options.resolution, std::vector<glm::vec3>(nodes * nodes)};
    for (std::size_t i = 0; i < nodes; ++i)
        for (std::size_t o = 0; o < nodes; ++o)
            table.values[i * nodes + o] = glm::vec3(0.5 * (rows[i][o] + rows[o][i]));
    return table;
}

}  // namespace nacre
