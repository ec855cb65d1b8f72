"""What many events together show, as the doctor says it of statistical laws; see clues.py."""

_PIECES = (
    ("{called} at depth {depth} bring {times} times what they should", "深度 {depth} 的{called}带来的光是应有的 {times} 倍"),
    ("{called} at depth {depth} and more bring {times} times what they should", "深度 {depth} 及更深的{called}带来的光是应有的 {times} 倍"),
    ("the picture is {times} times as bright as it should be", "图像的亮度是应有的 {times} 倍"),
    ("paths have {times} times as many vertices as they should", "路径的顶点数是应有的 {times} 倍"),
    ("the variance of samples is {times} times the right tracer's", "样本的方差是正确的追踪器的 {times} 倍"),
    ("first coordinate of points on {called} lamps", "{called}灯上的点的第一个坐标"),
    ("second coordinate of points on {called} lamps", "{called}灯上的点的第二个坐标"),
    ("first coordinate of points on each of the {called} lamps", "每盏{called}灯上的点的第一个坐标"),
    ("second coordinate of points on each of the {called} lamps", "每盏{called}灯上的点的第二个坐标"),
    ("places on the film lie {off} pixels beside the middle of theirs in {axis}", "胶片上的位置在 {axis} 方向偏离像素中心 {off} 像素"),
    ("the picture is stretched by {times} in {axis}", "图像在 {axis} 方向被拉伸 {times} 倍"),
    ("points on {called} lamps", "{called}灯上的点"),
    ("how often each face of a lamp is chosen", "灯的各个面被选中的频率"),
    ("number {k} for {called}", "{called}用的第 {k} 个随机数"),
    ("numbers {k} and {j} for {called}", "{called}用的第 {k} 和第 {j} 个随机数"),
    ("number {k} for {called} at neighbouring {neighbours}", "相邻{neighbours}处{called}用的第 {k} 个随机数"),
    ("number {k} for light and number {j} for bsdf", "光源用的第 {k} 个随机数与 BSDF 用的第 {j} 个随机数"),
    ("the numbers for {called}", "{called}用的随机数"),
    ("{distinct} different ones at {of} vertices", "{of} 个顶点处只有 {distinct} 个不同的"),
)  # fmt: skip
_TERMS = {
    "lamps that are met": "遇到的灯",
    "light samples": "光源样本",
    "the environment": "环境光",
    "light": "光源",
    "bsdf": "BSDF ",
    "roulette": "轮盘赌",
    "rectangle": "矩形",
    "quad": "矩形",
    "triangle": "三角形",
    "sphere": "球形",
    "disk": "圆盘",
    "depths": "深度",
    "samples": "样本",
    "pixels": "像素",
    "rows of pixels": "像素行",
    "red": "红色",
    "green": "绿色",
    "blue": "蓝色",
    "red and green": "红色和绿色",
    "red and blue": "红色和蓝色",
    "green and blue": "绿色和蓝色",
    "cos of the light sample": "光源样本的 cos",
    "pdf of the light sample": "光源样本的 pdf",
}
WORDS = {
    "en": {f"clue.many_{k}": said for k, (said, _) in enumerate(_PIECES)}
    | {f"called.{term}": term for term in _TERMS},
    "zh": {f"clue.many_{k}": said for k, (_, said) in enumerate(_PIECES)}
    | {f"called.{term}": said for term, said in _TERMS.items()},
}
