import sys, json, re, numpy as np
# usage: fold.py x.json WORKTREE
raw=json.load(open(sys.argv[1])); EX=raw['ex']; x=raw['x']
root=sys.argv[2]
sys.path.insert(0,'scratch'); 
NAMES=['out_early','out_late','twist','twist_end','toe_out','cadence','placement','solimp','kv','ankle_land','ankle_delay','ankle_late','knee_swing','hip_land','push_gain','brisk','sub_mid']
LO=[0.0,0,5,0.88,0.6,0.8,0.7,0.9,9,-3,-3,-3,-3,-3,-0.1,-2,-3]; HI=[3.0,0.6,14,0.97,1.2,1.2,1.5,0.97,20,3,3,3,3,3,0.2,3,3]
x=np.clip(x,LO,HI)
d=dict(zip(NAMES,x))
MAIN={0: 0, 30: 0, 60: 0, 66: 0.5, 71: 3.5, 76: 5, 84: 3, 93: 0.5}
CE9={0: 1, 4: -0.5, 10: 0, 35: 0, 58: 0, 62: 1, 66: 3, 70: 6, 75: 9.5, 80: 12, 85: 13.5, 90: 13, 94: 9.5, 97: 4.5}
p=root+'/models/gait.py'; s=open(p).read()
import subprocess
base=subprocess.run(['git','-C',root,'show','f11c152:models/gait.py'],capture_output=True,text=True).stdout
ns={}
def cur(name):
    m=re.search(r'^_%s = (\{.*?\})'%name,base,re.S|re.M); return eval(m.group(1))
an=cur('ANKLE'); kn=cur('KNEE'); sb=cur('SUBTALAR'); hp=cur('HIP')
for k in (95,0): an[k]+=d['ankle_land']
an[3]+=d['ankle_delay']; an[7]+=d['ankle_delay']
an[30]-=.3*d['ankle_late']; an[40]-=d['ankle_late']; an[45]-=d['ankle_late']
for k in (65,70,73,77,80): kn[k]+=d['knee_swing']
kn[50]-=.7*d['brisk']; kn[55]-=1.5*d['brisk']; kn[65]+=d['brisk']; an[50]+=1.3*d['brisk']; an[55]+=2*d['brisk']; an[63]-=.7*d['brisk']; an[66]-=.7*d['brisk']
for k in (15,30,45): sb[k]+=d['sub_mid']
for k in (95,0,5): hp[k]+=d['hip_land']
ad=cur('ADDUCTION')
for k in (20,30,40): ad[k]+=EX.get('add_mid',0)
sb[30]+=EX.get('sub_30',0)
# toes out: sum of two periodic curves sampled at the union of knots
sys.path.insert(0,root.rsplit('/',1)[0])
from scipy.interpolate import CubicSpline
def curve(c,at):
    ks=sorted(c); return CubicSpline([*ks,100],[*[c[k] for k in ks],c[ks[0]]],bc_type='periodic')(at)
knots=[0,4,10,35,58,62,66,70,75,80,85,90,94,97]
dense=np.arange(0,100,.5)
target=d['out_early']*curve(MAIN,dense)+d['out_late']*curve(CE9,dense)
vals={k:float(v) for k,v in zip(knots,d['out_early']*curve(MAIN,knots)+d['out_late']*curve(CE9,knots))}
r=lambda c:{k:round(float(v),2) if False else round(float(v),1) for k,v in c.items()}
out={k:round(v,1) for k,v in vals.items()}
print('toes fit err',np.abs(curve(out,dense)-target).max(), out)
def put(name,c):
    global s
    body=', '.join('%d: %g'%(k,v) for k,v in sorted(c.items()))
    line='_%s = {%s}  # fmt: skip'%(name,body)
    s,n=re.subn(r'^_%s = \{.*?\}(  # fmt: skip)?$'%name,line,s,count=1,flags=re.S|re.M); assert n==1,name
put('ANKLE',r(an)); put('KNEE',r(kn)); put('SUBTALAR',r(sb)); put('HIP',r(hp)); put('ADDUCTION',r(ad)); put('TOES_OUT',out)
s=re.sub(r'_ALOFT = \(.*?\)','_ALOFT = (0.61, %.3f)'%d['twist_end'],s)
open(p,'w').write(s)
p=root+'/models/body.py'; s=open(p).read()
s=re.sub(r'"hip_rotation": Servo\(250, [\d.]+','"hip_rotation": Servo(250, %.1f'%d['kv'],s)
lo=d['solimp']; hi=.98+(lo-.9)*.12
s=re.sub(r'"solimp": \[[^,]*, [^,]*,','"solimp": [%.3f, %.3f,'%(lo,hi),s); open(p,'w').write(s)
p=root+'/simulate/walker/_variability_kernels.py'; s=open(p).read()
c,t,pl=d['cadence'],d['toe_out'],d['placement']
s=re.sub(r'CADENCE_SD, CADENCE_SLOW_SD, CADENCE_SLOW_RHO = .*','CADENCE_SD, CADENCE_SLOW_SD, CADENCE_SLOW_RHO = %.4f, %.4f, 0.9'%(.0255*c,.013*c),s)
s=re.sub(r'AMPLITUDE_SD, BEND_SD = .*','AMPLITUDE_SD, BEND_SD = %.4f, %.4f'%(.02*pl,.05*pl),s)
s=re.sub(r'WIDTH_SD, WIDTH_RHO = .*','WIDTH_SD, WIDTH_RHO = %.4f, 0.5'%(.0055*pl),s)
s=re.sub(r'TOE_OUT_SD = math.*','TOE_OUT_SD = math.radians(%.2f)'%(1.9*t),s)
s=re.sub(r'TWIST_SD = math.radians\([\d.]+\)','TWIST_SD = math.radians(%.1f)'%d['twist'],s); open(p,'w').write(s)
print({k:round(float(v),3) for k,v in d.items()})
