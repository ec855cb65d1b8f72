"""Opening: a learner's own tracer, logs, files from the page."""

WORDS = {
    "en": {
        "given.running": "Running …",
        "given.own": "The picture is castray's own.",
        "given.findings": "{paths} paths, causes found: {n} (see Doctor).",
        "given.clean": "{paths} paths break no law.",
        "given.last_good": "Shown is the last good run.",
        "ui.given": "Your own tracer",
        "ui.given_show": "Show it again",
        "error.own_what_if": "what_if: is for castray's own paths, not for those of {name}",
        "error.own_find": "find: asks castray's own paths, not those of {name}",
        "error.own_pixel": "pixel {x} {y}: no path of it was recorded",
    },
    "zh": {
        "given.running": "正在运行……",
        "given.own": "显示的是 castray 自己的图像。",
        "given.findings": "{paths} 条路径，找到的原因：{n} 个（见“诊断”）。",
        "given.clean": "{paths} 条路径没有违反任何定律。",
        "given.last_good": "显示的是最近一次成功的运行。",
        "ui.given": "您自己的追踪器",
        "ui.given_show": "重新显示",
        "error.own_what_if": "what_if：用于 castray 自己的路径，不能用于 {name} 的路径",
        "error.own_find": "find：查询 castray 自己的路径，不能查询 {name} 的路径",
        "error.own_pixel": "像素 {x} {y}：没有记录它的路径",
    },
}
