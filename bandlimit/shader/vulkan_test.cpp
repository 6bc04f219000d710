#include "bandlimit/shader/vulkan_test.h"

#include <stdexcept>

#ifdef BANDLIMIT_TEST_VULKAN
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <cstring>
#include <functional>

namespace bandlimit::test {
namespace {

void require(VkResult result, const char* what) {
    if (result != VK_SUCCESS) throw std::runtime_error(std::string(what) + ": VkResult " + std::to_string(result));
}

VkSamplerAddressMode mode_of(Edge edge) {
    switch (edge) {
        case Edge::wrap: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
        case Edge::reflect: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case Edge::zero: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
        default: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    }
}

/// Undoes everything in reverse order.
class Cleanup {
public:
    ~Cleanup() {
        for (auto f = undo_.rbegin(); f != undo_.rend(); ++f) (*f)();
    }
    void later(std::function<void()> f) { undo_.push_back(std::move(f)); }

private:
    std::vector<std::function<void()>> undo_;
};

}  // namespace

struct Vulkan::State {
    Cleanup cleanup;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    VkPhysicalDeviceMemoryProperties memory{};
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t family = 0;

    void open();
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, Cleanup& c) const;
};

void Vulkan::State::open() {
    // A software driver compiles shaders for the CPU, which takes ten times longer than running ours: have it optimise
    // less. Other drivers do not look at these.
    setenv("GALLIVM_PERF", "nopt", 0);
    setenv("LP_NATIVE_VECTOR_WIDTH", "128", 0);
    const VkApplicationInfo app{
        VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "bandlimit", 1, nullptr, 0, VK_API_VERSION_1_2};
    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &app, 0, nullptr, 0, nullptr};
    require(vkCreateInstance(&create, nullptr, &instance), "vkCreateInstance");
    cleanup.later([this] { vkDestroyInstance(instance, nullptr); });

    std::uint32_t count = 1;
    vkEnumeratePhysicalDevices(instance, &count, &physical);
    if (count == 0) throw std::runtime_error("no Vulkan device");
    vkGetPhysicalDeviceProperties(physical, &properties);
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    while (family < count && !(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++family;
    if (family == count) throw std::runtime_error("no queue for compute");

    const float priority = 1;
    const VkDeviceQueueCreateInfo queues{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, family, 1, &priority};
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queues;
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(physical, &features);
    info.pEnabledFeatures = &features;
    require(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
    cleanup.later([this] { vkDestroyDevice(device, nullptr); });
    vkGetDeviceQueue(device, family, 0, &queue);
}

VkDeviceMemory Vulkan::State::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                                       Cleanup& c) const {
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if (!(needs.memoryTypeBits >> i & 1) || (memory.memoryTypes[i].propertyFlags & flags) != flags) continue;
        const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, i};
        VkDeviceMemory out = VK_NULL_HANDLE;
        require(vkAllocateMemory(device, &info, nullptr, &out), "vkAllocateMemory");
        c.later([d = device, out] { vkFreeMemory(d, out, nullptr); });
        return out;
    }
    throw std::runtime_error("no memory of the kind needed");
}

namespace {

struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    void* data = nullptr;
};

struct Texture {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
};

constexpr VkImageSubresourceLayers colour_layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

}  // namespace

/// One run: everything that is made for it, and undone after it.
class VulkanRun {
public:
    VulkanRun(const Vulkan::State& state, const Dispatch& dispatch) : s_(state), d_(dispatch) {}

    std::vector<float> operator()(const std::vector<std::uint32_t>& spirv) {
        begin();
        for (const Picture* p : d_.textures) inputs_.push_back(upload(*p));
        result_ =
            texture(d_.width, d_.height, result_format(), VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        barrier(result_.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        bind(spirv);
        vkCmdDispatch(commands_, static_cast<std::uint32_t>(d_.groups_x), static_cast<std::uint32_t>(d_.groups_y), 1);
        barrier(result_.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
        return download();
    }

private:
    VkFormat result_format() const {
        return d_.half_result ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
    }

    void begin() {
        const VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, s_.family};
        VkCommandPool pool = VK_NULL_HANDLE;
        require(vkCreateCommandPool(s_.device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
        later([this, pool] { vkDestroyCommandPool(s_.device, pool, nullptr); });
        const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        require(vkAllocateCommandBuffers(s_.device, &info, &commands_), "vkAllocateCommandBuffers");
        const VkCommandBufferBeginInfo once{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                            VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
        require(vkBeginCommandBuffer(commands_, &once), "vkBeginCommandBuffer");
    }

    Buffer buffer(VkDeviceSize size, VkBufferUsageFlags usage) {
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = size;
        info.usage = usage;
        Buffer b;
        require(vkCreateBuffer(s_.device, &info, nullptr, &b.handle), "vkCreateBuffer");
        later([this, h = b.handle] { vkDestroyBuffer(s_.device, h, nullptr); });
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(s_.device, b.handle, &needs);
        const VkDeviceMemory memory =
            s_.allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, cleanup_);
        require(vkBindBufferMemory(s_.device, b.handle, memory, 0), "vkBindBufferMemory");
        require(vkMapMemory(s_.device, memory, 0, size, 0, &b.data), "vkMapMemory");
        return b;
    }

    Texture texture(int width, int height, VkFormat format, VkImageUsageFlags usage) {
        VkImageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1};
        info.mipLevels = info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.tiling = VK_IMAGE_TILING_OPTIMAL;
        info.usage = usage;
        Texture t;
        require(vkCreateImage(s_.device, &info, nullptr, &t.image), "vkCreateImage");
        later([this, i = t.image] { vkDestroyImage(s_.device, i, nullptr); });
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(s_.device, t.image, &needs);
        require(vkBindImageMemory(s_.device, t.image, s_.allocate(needs, 0, cleanup_), 0), "vkBindImageMemory");
        VkImageViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        view.image = t.image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        require(vkCreateImageView(s_.device, &view, nullptr, &t.view), "vkCreateImageView");
        later([this, v = t.view] { vkDestroyImageView(s_.device, v, nullptr); });
        return t;
    }

    void barrier(VkImage image, VkImageLayout from, VkImageLayout to) {
        VkImageMemoryBarrier b{};
        b.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        b.srcAccessMask = b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        b.oldLayout = from;
        b.newLayout = to;
        b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        b.image = image;
        b.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                             nullptr, 0, nullptr, 1, &b);
    }

    Texture upload(const Picture& picture) {
        const std::string bytes = bytes_of(picture, d_.loads_floats);
        const Buffer staging = buffer(bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        std::memcpy(staging.data, bytes.data(), bytes.size());
        const Texture t = texture(picture.width, picture.height,
                                  d_.loads_floats ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT,
                                  VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        barrier(t.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
        const VkBufferImageCopy all = whole(picture.width, picture.height);
        vkCmdCopyBufferToImage(commands_, staging.handle, t.image, VK_IMAGE_LAYOUT_GENERAL, 1, &all);
        barrier(t.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
        return t;
    }

    static VkBufferImageCopy whole(int width, int height) {
        return {0,         0,
                0,         colour_layer,
                {0, 0, 0}, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1}};
    }

    VkSampler sampler() {
        VkSamplerCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
        info.magFilter = info.minFilter = VK_FILTER_LINEAR;
        info.addressModeU = info.addressModeV = info.addressModeW = mode_of(d_.edge);
        info.borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
        VkSampler out = VK_NULL_HANDLE;
        require(vkCreateSampler(s_.device, &info, nullptr, &out), "vkCreateSampler");
        later([this, out] { vkDestroySampler(s_.device, out, nullptr); });
        return out;
    }

    struct Binding {
        std::uint32_t index;
        VkDescriptorType type;
        VkDescriptorImageInfo info;
    };

    std::vector<Binding> bindings() {
        const VkSampler linear = sampler();
        std::vector<Binding> out;
        for (std::uint32_t i = 0; i < inputs_.size(); ++i)
            out.push_back({i == 0 ? 0 : i + 2,
                           d_.combined ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                           {linear, inputs_[i].view, VK_IMAGE_LAYOUT_GENERAL}});
        if (!d_.combined) out.push_back({1, VK_DESCRIPTOR_TYPE_SAMPLER, {linear, VK_NULL_HANDLE, {}}});
        out.push_back({2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {VK_NULL_HANDLE, result_.view, VK_IMAGE_LAYOUT_GENERAL}});
        return out;
    }

    void bind(const std::vector<std::uint32_t>& spirv) {
        const std::vector<Binding> all = bindings();
        std::vector<VkDescriptorSetLayoutBinding> slots;
        std::vector<VkDescriptorPoolSize> sizes;
        for (const Binding& b : all) {
            slots.push_back({b.index, b.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
            sizes.push_back({b.type, 1});
        }
        VkDescriptorSetLayoutCreateInfo set_info{};
        set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set_info.bindingCount = static_cast<std::uint32_t>(slots.size());
        set_info.pBindings = slots.data();
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        require(vkCreateDescriptorSetLayout(s_.device, &set_info, nullptr, &layout), "vkCreateDescriptorSetLayout");
        later([this, layout] { vkDestroyDescriptorSetLayout(s_.device, layout, nullptr); });
        VkDescriptorPoolCreateInfo pool_info{};
        pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        pool_info.maxSets = 1;
        pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
        pool_info.pPoolSizes = sizes.data();
        VkDescriptorPool pool = VK_NULL_HANDLE;
        require(vkCreateDescriptorPool(s_.device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
        later([this, pool] { vkDestroyDescriptorPool(s_.device, pool, nullptr); });
        const VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1,
                                                   &layout};
        VkDescriptorSet set = VK_NULL_HANDLE;
        require(vkAllocateDescriptorSets(s_.device, &allocate, &set), "vkAllocateDescriptorSets");
        for (const Binding& b : all) {
            VkWriteDescriptorSet write{};
            write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
            write.dstSet = set;
            write.dstBinding = b.index;
            write.descriptorCount = 1;
            write.descriptorType = b.type;
            write.pImageInfo = &b.info;
            vkUpdateDescriptorSets(s_.device, 1, &write, 0, nullptr);
        }
        const VkPipelineLayout pipeline = bind_pipeline(spirv, layout);
        vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, 0, 1, &set, 0, nullptr);
    }

    VkPipelineLayout bind_pipeline(const std::vector<std::uint32_t>& spirv, VkDescriptorSetLayout set) {
        VkPipelineLayoutCreateInfo layout_info{};
        layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout_info.setLayoutCount = 1;
        layout_info.pSetLayouts = &set;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        require(vkCreatePipelineLayout(s_.device, &layout_info, nullptr, &layout), "vkCreatePipelineLayout");
        later([this, layout] { vkDestroyPipelineLayout(s_.device, layout, nullptr); });
        VkShaderModuleCreateInfo module_info{};
        module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        module_info.codeSize = spirv.size() * sizeof(std::uint32_t);
        module_info.pCode = spirv.data();
        VkShaderModule module = VK_NULL_HANDLE;
        require(vkCreateShaderModule(s_.device, &module_info, nullptr, &module), "vkCreateShaderModule");
        later([this, module] { vkDestroyShaderModule(s_.device, module, nullptr); });
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = module;
        info.stage.pName = d_.entry.c_str();
        info.layout = layout;
        VkPipeline pipeline = VK_NULL_HANDLE;
        require(vkCreateComputePipelines(s_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
                "vkCreateComputePipelines");
        later([this, pipeline] { vkDestroyPipeline(s_.device, pipeline, nullptr); });
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
        return layout;
    }

    std::vector<float> download() {
        const std::size_t samples = static_cast<std::size_t>(d_.width) * static_cast<std::size_t>(d_.height) * 4;
        const Buffer staging = buffer(samples * (d_.half_result ? 2 : 4), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        const VkBufferImageCopy all = whole(d_.width, d_.height);
        vkCmdCopyImageToBuffer(commands_, result_.image, VK_IMAGE_LAYOUT_GENERAL, staging.handle, 1, &all);
        require(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
        VkSubmitInfo submit{};
        submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
        submit.commandBufferCount = 1;
        submit.pCommandBuffers = &commands_;
        require(vkQueueSubmit(s_.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
        require(vkQueueWaitIdle(s_.queue), "vkQueueWaitIdle");
        if (!d_.half_result) {
            const auto* values = static_cast<const float*>(staging.data);
            return {values, values + samples};
        }
        const auto* halves = static_cast<const Half*>(staging.data);
        std::vector<float> out;
        for (std::size_t i = 0; i < samples; ++i) out.push_back(to_float(halves[i]));
        return out;
    }

    void later(std::function<void()> f) { cleanup_.later(std::move(f)); }

    const Vulkan::State& s_;
    const Dispatch& d_;
    Cleanup cleanup_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    std::vector<Texture> inputs_;
    Texture result_;
};

std::string Vulkan::missing() {
    try {
        Vulkan();
        return "";
    } catch (const std::runtime_error& e) {
        return e.what();
    }
}

Vulkan::Vulkan() : state_(std::make_unique<State>()) { state_->open(); }

Vulkan::~Vulkan() = default;

std::string Vulkan::device() const { return state_->properties.deviceName; }

int Vulkan::fraction_bits() const { return static_cast<int>(state_->properties.limits.subTexelPrecisionBits); }

std::vector<float> Vulkan::run(const std::vector<std::uint32_t>& spirv, const Dispatch& dispatch) const {
    return VulkanRun(*state_, dispatch)(spirv);
}

}  // namespace bandlimit::test

#else

namespace bandlimit::test {

struct Vulkan::State {};
std::string Vulkan::missing() { return "built without the headers of Vulkan (libvulkan-dev)"; }
Vulkan::Vulkan() { throw std::runtime_error(missing()); }
Vulkan::~Vulkan() = default;
std::string Vulkan::device() const { return ""; }
int Vulkan::fraction_bits() const { return 0; }
std::vector<float> Vulkan::run(const std::vector<std::uint32_t>&, const Dispatch&) const { return {}; }

}  // namespace bandlimit::test

#endif
