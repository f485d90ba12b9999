// The bakes of a manifest: in parallel, each after those that make its inputs, each failing alone.
#pragma once

#include <vector>

#include "core/progress.hpp"
#include "core/scene_description.hpp"

namespace nacre::cli {

struct BakeOptions {
    unsigned jobs = 0;    ///< at a time; 0 = one a core
    bool force = false;   ///< also what is up to date
    bool dryRun = false;  ///< only say what would be done
};

struct BakeResult {
    enum class Status { Baked, Skipped, Failed, ToBake, Given } status = Status::Skipped;
    std::string why;       ///< of failed ones the message, of others why they were or would be baked
    std::string messages;  ///< what the bake said on standard error, lines without "nacre: "
    double seconds = 0;
    std::uintmax_t bytes = 0;  ///< of the file, where there is one
};

/// One result an asset. An asset whose source is another's file waits for it, and fails with it. Each child computes
/// with cores / (children at a time) threads, at least one, unless its recipe has --threads.
std::vector<BakeResult> bakeAll(const std::vector<SceneAsset>& assets, const BakeOptions& options,
                                const Progress& progress);

/// Which of `assets` are needed for those at `wanted`: these, and what they are made from. In ascending order.
std::vector<std::size_t> withInputs(const std::vector<SceneAsset>& assets, const std::vector<std::size_t>& wanted);

}  // namespace nacre::cli
