"""What the settings mean, in other languages; the English stands beside each in tracer/settings.py."""

WORDS = {
    "zh": {
        "setting.width": "图像宽度，以像素计（默认：依场景）",
        "setting.height": "图像高度，以像素计（默认：依场景）",
        "setting.size": "宽度和高度，以像素计（默认：依场景）",
        "setting.set": "换一种说法读场景里的一个词：OBJECT.WORD=VALUE，如 white.reflectance=0.5；可以重复",
        "setting.spp": "每像素的样本数",
        "setting.seed": "所有随机数的种子",
        "setting.max_depth": "最长的路径：1 = 只看直接可见的自发光，2 = 加上直接光照，-1 = 不限",
        "setting.integrator": "用哪个循环",
        "setting.strategy": "path 怎样找到光源：两种方式加权，或只用一种",
        "setting.heuristic": "MIS 权重",
        "setting.hemisphere": "漫反射表面怎样选择方向",
        "setting.roulette": "俄罗斯轮盘赌：auto、off，或 (0, 1] 内的一个存活概率",
        "setting.light_sampling": "怎样选灯上的点：在接受点看来均匀（矩形、球），或按面积",
        "setting.sampler": "随机数怎样落点：各自独立，或在一个像素的样本间均匀分布",
        "setting.replicates": "像素的样本分给多少个独立的点阵：从 2 个起，它们的平均给出误差",
        "setting.precision": "浮点数的位数",
        "setting.accel": "谁来查找大网格的三角形：castray 自己的树，或 Embree（需要 embreex）",
        "setting.jitter": "样本在像素内散开（关：全部穿过中心）",
        "setting.bug": "植入错误动物园中的错误，多个时用逗号分开（castray bugs 列出它们）",
    },
}
