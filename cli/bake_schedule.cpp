#include "cli/bake_schedule.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include "cli/bake_record.hpp"
#include "cli/child_process.hpp"
#include "cli/output_file.hpp"
#include "core/error.hpp"

namespace nacre::cli {

namespace fs = std::filesystem;
using Status = BakeResult::Status;

namespace {

/// For each asset, those whose file is one of its inputs.
std::vector<std::vector<std::size_t>> inputsOf(const std::vector<SceneAsset>& assets) {
    std::vector<std::vector<std::size_t>> out(assets.size());
    std::map<fs::path, std::size_t> makers;
    for (std::size_t i = 0; i < assets.size(); ++i) makers.emplace(fs::weakly_canonical(assets[i].file), i);
    for (std::size_t i = 0; i < assets.size(); ++i) {
        if (!assets[i].bake) continue;
        for (const std::string& input : assets[i].bake->inputs)
            if (const auto maker = makers.find(fs::weakly_canonical(input)); maker != makers.end())
                out[i].push_back(maker->second);
    }
    return out;
}

/// "nacre: a\nnacre: b\n" as "a\nb".
std::string withoutPrefix(const std::string& errors) {
    std::string out;
    std::size_t begin = 0;
    while (begin < errors.size()) {
        const std::size_t end = std::min(errors.find('\n', begin), errors.size());
        std::string line = errors.substr(begin, end - begin);
        if (line.rfind("nacre: ", 0) == 0) line.erase(0, 7);
        if (!line.empty()) out += (out.empty() ? "" : "\n") + line;
        begin = end + 1;
    }
    return out;
}

std::vector<std::string> argumentsOf(const SceneAsset& asset, unsigned threads) {
    const BakeRecipe& recipe = *asset.bake;
    std::vector<std::string> out = {recipe.verb};
    if (!recipe.source.empty()) out.push_back(recipe.source);
    out.insert(out.end(), {"-o", asset.file.string(), "--quiet"});
    out.insert(out.end(), recipe.options.begin(), recipe.options.end());
    const bool says = std::find(recipe.options.begin(), recipe.options.end(), "--threads") != recipe.options.end();
    if (!says && recipe.verb != "fresnel") out.insert(out.end(), {"--threads", std::to_string(threads)});
    return out;
}

class Schedule {
public:
    Schedule(const std::vector<SceneAsset>& assets, const BakeOptions& options, const Progress& progress)
        : assets_(assets),
          options_(options),
          progress_(progress),
          inputs_(inputsOf(assets)),
          results_(assets.size()),
          stages_(assets.size(), Stage::Waiting) {
        cores_ = std::max(1u, std::thread::hardware_concurrency());
        jobs_ = options.jobs > 0 ? options.jobs : cores_;
    }

    std::vector<BakeResult> run() {
        for (;;) {
            startWhatCan();
            if (running_.empty()) break;
            waitForOne();
        }
        for (std::size_t i = 0; i < assets_.size(); ++i)
            if (stages_[i] == Stage::Waiting)
                finish(i, Status::Failed, "it is made from itself, through " + assets_[inputs_[i][0]].name);
        return std::move(results_);
    }

private:
    enum class Stage { Waiting, Running, Done };
    struct Running {
        std::size_t asset;
        std::string hash;
        Stopwatch watch;
        std::unique_ptr<ChildProcess> child;
    };

    void finish(std::size_t i, Status status, const std::string& why) {
        stages_[i] = Stage::Done;
        results_[i].status = status;
        results_[i].why = why;
        std::error_code none;
        const std::uintmax_t bytes = fs::file_size(assets_[i].file, none);
        results_[i].bytes = none ? 0 : bytes;
        ++done_;
        report(progress_, "baking", static_cast<double>(done_) / static_cast<double>(assets_.size()));
    }

    /// Again from the start whenever something ends at once: others may have waited for it.
    void startWhatCan() {
        bool again = true;
        while (again) {
            again = false;
            for (std::size_t i = 0; i < assets_.size() && running_.size() < jobs_; ++i)
                if (stages_[i] == Stage::Waiting && consider(i)) again = true;
        }
    }

    /// \return whether the asset is done now
    bool consider(std::size_t i) {
        for (const std::size_t input : inputs_[i]) {
            if (stages_[input] != Stage::Done) return false;
            if (results_[input].status != Status::Failed) continue;
            finish(i, Status::Failed, fmt::format("it is made from \"{}\", which failed", assets_[input].name));
            return true;
        }
        try {
            return considerAlone(i);
        } catch (const std::exception& error) {
            finish(i, Status::Failed, error.what());
            return true;
        }
    }

    bool considerAlone(std::size_t i) {
        const SceneAsset& asset = assets_[i];
        if (!asset.bake) {
            const bool there = stateOf(asset, {}).kind == AssetState::Kind::Given;
            finish(i, there ? Status::Given : Status::Failed,
                   there
                       ? ""
                       : fmt::format("{}: expected a file, found none, and no recipe to bake it", asset.file.string()));
            return true;
        }
        const bool waits = options_.dryRun && std::any_of(inputs_[i].begin(), inputs_[i].end(), [&](std::size_t k) {
                               return results_[k].status == Status::ToBake;
                           });
        if (waits) return finish(i, Status::ToBake, "what it is made from is baked before"), true;
        const std::string hash = recipeHash(*asset.bake);
        const AssetState state = stateOf(asset, hash);
        if (state.kind == AssetState::Kind::Baked && !options_.force) return finish(i, Status::Skipped, ""), true;
        results_[i].why = state.kind == AssetState::Kind::Missing ? "missing"
                          : state.kind == AssetState::Kind::Baked ? "--force"
                                                                  : state.why;
        if (options_.dryRun) return finish(i, Status::ToBake, results_[i].why), true;
        start(i, hash);
        return false;
    }

    void start(std::size_t i, const std::string& hash) {
        if (const fs::path folder = assets_[i].file.parent_path(); !folder.empty()) fs::create_directories(folder);
        removeLeftovers(assets_[i]);
        const auto left = static_cast<unsigned>(assets_.size() - done_);
        const unsigned threads = std::max(1u, cores_ / std::min(jobs_, left));
        running_.push_back({i, hash, {}, std::make_unique<ChildProcess>(argumentsOf(assets_[i], threads))});
        stages_[i] = Stage::Running;
    }

    void waitForOne() {
        std::vector<pollfd> polled;
        for (const Running& job : running_) polled.push_back({job.child->descriptor(), POLLIN, 0});
        if (::poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR)
            throw Error(fmt::format("poll: {}", std::strerror(errno)));
        for (std::size_t k = running_.size(); k-- > 0;)
            if (polled[k].revents != 0 && !running_[k].child->takeErrors()) end(k);
    }

    void end(std::size_t k) {
        const Running job = std::move(running_[k]);
        running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(k));
        const int code = job.child->wait();
        BakeResult& result = results_[job.asset];
        result.seconds = job.watch.seconds();
        std::string said = withoutPrefix(job.child->errors());
        if (code != 0) {
            if (code > 128) said += (said.empty() ? "" : "\n") + fmt::format("ended by signal {}", code - 128);
            return finish(job.asset, Status::Failed, said.empty() ? fmt::format("exit code {}", code) : said);
        }
        result.messages = said;
        try {
            // The hash from before the bake: what changed meanwhile makes it stale.
            writeRecord(assets_[job.asset], job.hash, result.seconds);
            finish(job.asset, Status::Baked, result.why);
        } catch (const std::exception& error) {
            finish(job.asset, Status::Failed, error.what());
        }
    }

    const std::vector<SceneAsset>& assets_;
    const BakeOptions& options_;
    const Progress& progress_;
    std::vector<std::vector<std::size_t>> inputs_;
    std::vector<BakeResult> results_;
    std::vector<Stage> stages_;
    std::vector<Running> running_;
    std::size_t done_ = 0;
    unsigned cores_ = 1, jobs_ = 1;
};

}  // namespace

std::vector<BakeResult> bakeAll(const std::vector<SceneAsset>& assets, const BakeOptions& options,
                                const Progress& progress) {
    return Schedule(assets, options, progress).run();
}

std::vector<std::size_t> withInputs(const std::vector<SceneAsset>& assets, const std::vector<std::size_t>& wanted) {
    const auto inputs = inputsOf(assets);
    std::set<std::size_t> out;
    std::vector<std::size_t> open = wanted;
    while (!open.empty()) {
        const std::size_t next = open.back();
        open.pop_back();
        if (out.insert(next).second) open.insert(open.end(), inputs[next].begin(), inputs[next].end());
    }
    return {out.begin(), out.end()};
}

}  // namespace nacre::cli
