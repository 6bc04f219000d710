"""Runs compute shaders in WGSL by wgpu, whose compiler is naga: wgpu_test.py FOLDER

FOLDER/jobs.json lists jobs, each with: shader, entry, textures (files of RGBA
halves, or floats that are read without a sampler), texture_sizes, floats, address, size of the
result, groups, and output. A result is written as RGBA floats.
"""
import json
import pathlib
import sys

import wgpu


def texture(device, size, usage, format):
    return device.create_texture(size=(*size, 1), usage=usage, format=format)


def run(device, folder, job, modules):
    source = (folder / job["shader"]).read_text()
    if source not in modules:
        modules[source] = device.create_shader_module(code=source)
    entries = []
    floats = job["floats"]
    for index, (name, (width, height)) in enumerate(zip(job["textures"], job["texture_sizes"])):
        picture = texture(device, (width, height), wgpu.TextureUsage.TEXTURE_BINDING | wgpu.TextureUsage.COPY_DST,
                          "rgba32float" if floats else "rgba16float")
        device.queue.write_texture({"texture": picture}, (folder / name).read_bytes(),
                                   {"bytes_per_row": width * (16 if floats else 8), "rows_per_image": height},
                                   (width, height, 1))
        entries.append({"binding": index + 2 if index else 0, "resource": picture.create_view()})
    mode = job["address"]
    if not floats:
        entries.append({"binding": 1, "resource": device.create_sampler(
            mag_filter="linear", min_filter="linear", address_mode_u=mode, address_mode_v=mode)})
    width, height = job["size"]
    result = texture(device, (width, height), wgpu.TextureUsage.STORAGE_BINDING | wgpu.TextureUsage.COPY_SRC,
                     job["format"])
    entries.append({"binding": 2, "resource": result.create_view()})
    pipeline = device.create_compute_pipeline(
        layout="auto", compute={"module": modules[source], "entry_point": job["entry"]})
    group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=entries)
    encoder = device.create_command_encoder()
    work = encoder.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(*job["groups"])
    work.end()
    device.queue.submit([encoder.finish()])
    pixel = 8 if job["format"] == "rgba16float" else 16
    pixels = device.queue.read_texture({"texture": result}, {"bytes_per_row": width * pixel, "rows_per_image": height},
                                       (width, height, 1))
    (folder / job["output"]).write_bytes(pixels)


def main():
    folder = pathlib.Path(sys.argv[1])
    adapter = wgpu.gpu.request_adapter_sync(power_preference="high-performance")
    device = adapter.request_device_sync()
    print(adapter.info["device"])
    modules = {}
    for job in json.loads((folder / "jobs.json").read_text()):
        run(device, folder, job, modules)


main()
