"""Pages that stand alone: a pixel's paths in 3D, and the site of the lessons."""

WORDS = {
    "en": {
        "offline.title": "castray: pixel ({x}, {y}) of {scene}",
        "offline.path": "path {path}",
        "offline.help": "Drag turns, the wheel zooms, Shift and drag moves; ← → walk along the path, ↑ ↓ change it.",
        "ui.no_webgl": "This browser cannot draw in 3D (it has no WebGL).",
    },
    "zh": {
        "offline.title": "castray：{scene} 的像素 ({x}, {y})",
        "offline.path": "路径 {path}",
        "offline.help": "拖动旋转，滚轮缩放，按住 Shift 拖动平移；← → 沿路径前进后退，↑ ↓ 换一条路径。",
        "ui.no_webgl": "这个浏览器不能显示三维图形（没有 WebGL）。",
    },
}
