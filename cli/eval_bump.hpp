// nacre eval for assets of kind bump.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/asset.hpp"
#include "core/math.hpp"

namespace nacre::cli {

enum class BumpQuestion {
    Lit,    ///< u,v,lx,ly,lz → lit,lit_truth
    Seen,   ///< u,v,dx,dy,dz → hit,u,v,hit_truth,u_truth,v_truth
    Normal  ///< u,v → x,y,z
};

struct BumpQuery {
    Vec2 uv{0};
    Vec3 direction{0, 0, 1};  ///< unit
};

/// Reads lines u,v,x,y,z (direction of any length > 0) or, for normals, u,v. Blank lines, lines that start with # and a
/// header that starts with u are skipped.
class BumpQueryReader {
public:
    explicit BumpQueryReader(BumpQuestion question = BumpQuestion::Lit) : question_(question) {}
    /// Appends the query of `line`. \throws nacre::Error "standard input: line N: expected …, found …"
    void take(std::string_view line, std::vector<BumpQuery>& queries);

private:
    BumpQuestion question_;
    std::size_t lineNumber_ = 0;
    bool sawContent_ = false;
};

/// An answer for each line of standard input: what a shader gets from the file, and the truth, nan unless there are
/// heights: `source`'s, read as the asset says it was, or the asset's own.
/// \throws nacre::Error also when the asset lacks what is asked, or the source has another size
void evalBump(const Asset& asset, const std::string& file, const std::string& source, BumpQuestion question,
              unsigned threads);

}  // namespace nacre::cli
